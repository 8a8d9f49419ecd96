// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

namespace UnityEngine
{
    public class MonoBehaviour : Behaviour
    {
        /// <summary>What the life cycle knows about the script.</summary>
        internal ScriptState State { get; } = new ScriptState();

        internal override void OnDestroying()
        {
            Lifecycle.Destroy(this);
            base.OnDestroying();
        }
    }
}
