// SPDX-License-Identifier: MIT
using System;
using System.Collections;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// Object.Instantiate: a copy of a hierarchy that shares nothing with the original but the objects outside of it.
    /// Scripts have copies of what is serialised, which here, unlike in a reload, are private fields with
    /// SerializeField only; everything else is as in a new instance.
    /// </summary>
    internal sealed class Duplication
    {
        private readonly Dictionary<Object, Object> _copies = new Dictionary<Object, Object>();
        private readonly List<MonoBehaviour> _scripts = new List<MonoBehaviour>();
        private bool _isForFile;

        /// <summary>The copy of a GameObject, or of a component with its GameObject, after its scripts woke.</summary>
        public static Object Run(Object original, Transform parent, bool worldPositionStays)
        {
            EngineThread.Require("Instantiate");
            if (original == null)
                throw new ArgumentException("The Object you want to instantiate is null.");
            GameObject root = original as GameObject ?? (original as Component)?.Owner ??
                throw new NotSupportedException(
                    $"The double of the engine instantiates GameObjects and components, not {original.GetType()}.");
            var duplication = new Duplication();
            GameObject copy = duplication.CopyObjects(root, null);
            copy.name += "(Clone)";
            foreach (KeyValuePair<Object, Object> pair in duplication._copies)
                if (pair.Key is Component component)
                    duplication.CopyState(component, (Component)pair.Value);
            copy.transform.SetParent(parent, worldPositionStays);
            Lifecycle.BeginCopies(duplication._scripts);
            Object result = duplication._copies[original];
            return result != null ? result : throw new UnityException("Instantiate failed because the clone was " +
                "destroyed during creation. This can happen if DestroyImmediate is called in MonoBehaviour.Awake.");
        }

        /// <summary>
        /// The copy of a GameObject that goes into a file: it is told nothing, and has no references to what is in none.
        /// </summary>
        public static GameObject ForFile(GameObject root)
        {
            var duplication = new Duplication { _isForFile = true };
            GameObject copy = duplication.CopyObjects(root, null);
            foreach (KeyValuePair<Object, Object> pair in duplication._copies)
            {
                pair.Value.IsPersistent = true;
                if (pair.Key is Component component)
                    duplication.CopyState(component, (Component)pair.Value);
                if (pair.Value is Component copied)
                    copied.DropReferences(each => !each.IsPersistent);
            }

            return copy;
        }

        /// <summary>What is serialised of an object of the same type, with the same references.</summary>
        public static void CopyFields(Object from, Object to) => new Duplication().CopyFields(from, to, from.GetType());

        private GameObject CopyObjects(GameObject original, Transform parent)
        {
            GameObject copy = GameObject.CopyOf(original);
            _copies.Add(original, copy);
            for (int i = 0; i < original.Components.Count; ++i)
            {
                _copies.Add(original.Components[i], copy.Components[i]);
                if (copy.Components[i] is MonoBehaviour script)
                    _scripts.Add(script);
            }

            copy.transform.SetParent(parent, false);
            for (int i = 0; i < original.transform.childCount; ++i)
                CopyObjects(original.transform.GetChild(i).Owner, copy.transform);
            return copy;
        }

        private void CopyState(Component original, Component copy)
        {
            copy.CopyStateOf(original);
            if (original is MonoBehaviour)
                CopyFields(original, copy, original.GetType());
        }

        private void CopyFields(object from, object to, Type type)
        {
            for (; type != typeof(MonoBehaviour) && type != typeof(ScriptableObject) && type != typeof(object) && type != typeof(ValueType);
                type = type.BaseType)
            {
                if (!typeof(Object).IsAssignableFrom(type) && !type.IsDefined(typeof(SerializableAttribute), false))
                    continue;
                foreach (FieldInfo field in Serialization.FieldsOf(type))
                    field.SetValue(to, CopyOf(field.GetValue(from), field.FieldType));
            }
        }

        // What counts is the type of the field: it is not known to files that a value is of a derived one.
        private object CopyOf(object value, Type type)
        {
            if (typeof(Object).IsAssignableFrom(type))
                return CopyOfReference((Object)value);
            if (value == null)
                return Serialization.EmptyValue(type);
            if (type.IsArray)
                return CopyOfElements((IList)value, Array.CreateInstance(type.GetElementType(), ((IList)value).Count),
                    type.GetElementType());
            if (type.IsGenericType && type.GetGenericTypeDefinition() == typeof(List<>))
                return CopyOfElements((IList)value, (IList)Activator.CreateInstance(type),
                    type.GetGenericArguments()[0]);
            if (!Serialization.IsInline(type))
                return value;
            object copy = Activator.CreateInstance(type, true);
            CopyFields(value, copy, type);
            return copy;
        }

        private Object CopyOfReference(Object value)
        {
            if (value == null)
                return null;
            if (_copies.TryGetValue(value, out Object copy))
                return copy;
            return _isForFile && !value.IsPersistent ? null : value;
        }

        private IList CopyOfElements(IList from, IList to, Type type)
        {
            for (int i = 0; i < from.Count; ++i)
            {
                object copy = CopyOf(from[i], type);
                if (to.IsFixedSize)
                    to[i] = copy;
                else
                    to.Add(copy);
            }

            return to;
        }
    }
}
