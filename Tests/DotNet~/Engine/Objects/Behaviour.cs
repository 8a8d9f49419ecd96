// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

namespace UnityEngine
{
    public class Behaviour : Component
    {
        private bool _enabled = true;

        public bool enabled
        {
            get
            {
                RequireAlive("get_enabled");
                return _enabled;
            }
            set
            {
                RequireAlive("set_enabled");
                if (_enabled == value)
                    return;
                _enabled = value;
                if (this is MonoBehaviour script)
                    Lifecycle.Refresh(script);
            }
        }

        public bool isActiveAndEnabled
        {
            get
            {
                RequireAlive("get_isActiveAndEnabled");
                return _enabled && Owner.activeInHierarchy;
            }
        }

        internal override void CopyStateOf(Component original) => _enabled = ((Behaviour)original)._enabled;
    }
}
