// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using System.Linq;
using UnityEngine.SceneManagement;

namespace UnityEngine
{
    public enum PrimitiveType
    {
        Sphere,
        Capsule,
        Cylinder,
        Cube,
        Plane,
        Quad
    }

    public sealed class GameObject : Object
    {
        private readonly List<Component> _components = new List<Component>();
        private readonly Transform _transform;
        private bool _activeSelf = true;

        public GameObject() : this("New Game Object")
        {
        }

        public GameObject(string name) : this(name, Array.Empty<Type>())
        {
        }

        public GameObject(string name, params Type[] components)
        {
            this.name = name;
            _transform = (Transform)Append(new Transform());
            foreach (Type component in components)
                AddComponent(component);
        }

        internal bool IsInPrefabStage { get; set; }

        internal IReadOnlyList<Component> Components => _components;

        public Transform transform
        {
            get
            {
                RequireAlive("get_transform");
                return _transform;
            }
        }

        public string tag { get; set; } = "Untagged";

        public int layer { get; set; }

        /// <summary>Not valid: it is in none, but an asset or a prefab that is open for editing.</summary>
        public Scene scene
        {
            get
            {
                RequireAlive("get_scene");
                return IsPersistent || _transform.Root.IsInPrefabStage ? default : SceneManager.GetActiveScene();
            }
        }

        public bool activeSelf => _activeSelf;

        public bool activeInHierarchy
        {
            get
            {
                RequireAlive("get_activeInHierarchy");
                for (GameObject at = this; at != null; at = at._transform.ParentObject)
                    if (!at._activeSelf)
                        return false;
                return true;
            }
        }

        public void SetActive(bool value)
        {
            RequireAlive("SetActive");
            if (_activeSelf == value)
                return;
            _activeSelf = value;
            Lifecycle.RefreshHierarchy(this);
        }

        public T AddComponent<T>() where T : Component => (T)AddComponent(typeof(T));

        public Component AddComponent(Type componentType)
        {
            RequireAlive("AddComponent");
            if (componentType.IsAbstract || !typeof(Component).IsAssignableFrom(componentType))
                throw new ArgumentException($"{componentType} is no component that can be added.");
            MessageTable table = MessageTable.Of(componentType);
            Type single = table.SingleType;
            if (single != null && GetComponent(single) != null)
            {
                Debug.LogError($"Can't add component '{componentType.Name}' to {name} because such a component is " +
                    "already added to the game object!");
                return null;
            }

            foreach (Type required in table.RequiredTypes)
                if (GetComponent(required) == null)
                    AddComponent(required);
            Component component = Append((Component)Activator.CreateInstance(componentType, true));
            if (component is MonoBehaviour script)
                Lifecycle.Begin(script);
            return component;
        }

        public T GetComponent<T>()
        {
            TryGetComponent(out T component);
            return component;
        }

        public Component GetComponent(Type type)
        {
            TryGetComponent(type, out Component component);
            return component;
        }

        public T[] GetComponents<T>()
        {
            RequireAlive("GetComponents");
            return _components.OfType<T>().ToArray();
        }

        /// <summary>Its own, or else that of the first child that has one, or one below it.</summary>
        public T GetComponentInChildren<T>(bool includeInactive)
        {
            if ((includeInactive || activeInHierarchy) && TryGetComponent(out T own))
                return own;
            for (int i = 0; i < transform.childCount; ++i)
            {
                T found = transform.GetChild(i).Owner.GetComponentInChildren<T>(includeInactive);
                if (found != null)
                    return found;
            }

            return default;
        }

        /// <summary>Of the double, without a collider, and all with the same mesh.</summary>
        public static GameObject CreatePrimitive(PrimitiveType type)
        {
            var made = new GameObject(type.ToString(), typeof(MeshFilter), typeof(MeshRenderer));
            made.GetComponent<MeshFilter>().sharedMesh = Resources.BuiltinMesh;
            made.GetComponent<MeshRenderer>().sharedMaterial = Resources.BuiltinMaterial;
            return made;
        }

        public bool TryGetComponent<T>(out T component)
        {
            RequireAlive("TryGetComponent");
            foreach (Component candidate in _components)
            {
                if (candidate is T match)
                {
                    component = match;
                    return true;
                }
            }

            component = default;
            return false;
        }

        public bool TryGetComponent(Type type, out Component component)
        {
            RequireAlive("TryGetComponent");
            component = _components.Find(type.IsInstanceOfType);
            return component != null;
        }

        /// <summary>Components of the same types, still as new, of which none was told anything; no children.</summary>
        internal static GameObject CopyOf(GameObject original)
        {
            var copy = new GameObject(original.name)
            {
                tag = original.tag, layer = original.layer, hideFlags = original.hideFlags
            };
            copy._activeSelf = original._activeSelf;
            for (int i = 1; i < original._components.Count; ++i) // the first is the Transform
                copy.Append((Component)Activator.CreateInstance(original._components[i].GetType(), true));
            return copy;
        }

        internal Component ComponentThatRequires(Component required)
        {
            foreach (Component candidate in _components)
            {
                if (candidate.IsDestructionPending)
                    continue;
                foreach (Type type in MessageTable.Of(candidate.GetType()).RequiredTypes)
                    if (type.IsInstanceOfType(required) && !HasAnother(type, required))
                        return candidate;
            }

            return null;
        }

        internal void Remove(Component component) => _components.Remove(component);

        // Scripts are told while the hierarchy and all components are still there.
        internal override void OnDestroying()
        {
            Lifecycle.DestroyScripts(this);
            while (_transform.childCount > 0)
                _transform.GetChild(_transform.childCount - 1).Owner.DestroyNow();
            _transform.Detach();
            for (int i = _components.Count - 1; i >= 0; --i)
                _components[i].DestroyNow();
        }

        private bool HasAnother(Type type, Component than)
        {
            foreach (Component candidate in _components)
                if (!ReferenceEquals(candidate, than) && type.IsInstanceOfType(candidate))
                    return true;
            return false;
        }

        private Component Append(Component component)
        {
            component.AttachTo(this);
            _components.Add(component);
            return component;
        }
    }
}
