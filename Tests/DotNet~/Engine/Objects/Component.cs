// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    public class Component : Object
    {
        private GameObject _gameObject;

        public GameObject gameObject
        {
            get
            {
                RequireAlive("get_gameObject");
                return _gameObject;
            }
        }

        public Transform transform
        {
            get
            {
                RequireAlive("get_transform");
                return _gameObject.transform;
            }
        }

        /// <summary>The GameObject, without the checks: also of a component that was destroyed.</summary>
        internal GameObject Owner => _gameObject;

        // Of components, the name is the GameObject's.
        public new string name
        {
            get => gameObject.name;
            set => gameObject.name = value;
        }

        public T GetComponent<T>() => gameObject.GetComponent<T>();

        internal void AttachTo(GameObject gameObject) => _gameObject = gameObject;

        /// <summary>Takes what the engine itself serialises of a component of the same type.</summary>
        internal virtual void CopyStateOf(Component original)
        {
        }

        /// <summary>Forgets objects that the engine itself serialises a reference to.</summary>
        internal virtual void DropReferences(Predicate<Object> isDropped)
        {
        }

        internal override bool MayBeDestroyed()
        {
            if (_gameObject == null)
                return true;
            Component dependent = _gameObject.ComponentThatRequires(this);
            if (dependent == null)
                return true;
            Debug.LogError($"Can't remove {GetType().Name} because {dependent.GetType().Name} (Script) depends on it");
            return false;
        }

        internal override void OnDestroying()
        {
            if (_gameObject is null)
                return;
            _gameObject.Remove(this);
        }
    }
}
