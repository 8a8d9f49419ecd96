// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

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

        public string tag
        {
            get => gameObject.tag;
            set => gameObject.tag = value;
        }

        // Of components, the name is the GameObject's.
        public new string name
        {
            get => gameObject.name;
            set => gameObject.name = value;
        }

        public bool CompareTag(string tag) => gameObject.CompareTag(tag);

        public T GetComponent<T>() => gameObject.GetComponent<T>();

        public Component GetComponent(Type type) => gameObject.GetComponent(type);

        public bool TryGetComponent<T>(out T component) => gameObject.TryGetComponent(out component);

        public bool TryGetComponent(Type type, out Component component) =>
            gameObject.TryGetComponent(type, out component);

        public T[] GetComponents<T>() => gameObject.GetComponents<T>();

        public void GetComponents<T>(List<T> results) => gameObject.GetComponents(results);

        public T GetComponentInChildren<T>() => gameObject.GetComponentInChildren<T>();

        public T GetComponentInChildren<T>(bool includeInactive) =>
            gameObject.GetComponentInChildren<T>(includeInactive);

        public T[] GetComponentsInChildren<T>() => gameObject.GetComponentsInChildren<T>();

        public T[] GetComponentsInChildren<T>(bool includeInactive) =>
            gameObject.GetComponentsInChildren<T>(includeInactive);

        public T GetComponentInParent<T>() => gameObject.GetComponentInParent<T>();

        internal void AttachTo(GameObject gameObject) => _gameObject = gameObject;

        /// <summary>Takes what the engine itself serialises of a component of the same type.</summary>
        internal virtual void CopyStateOf(Component original)
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
