// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// <summary>Of one script. What is set waits until it is applied.</summary>
    public class SerializedObject : IDisposable
    {
        private readonly Dictionary<string, object> _changes = new Dictionary<string, object>();

        public SerializedObject(Object obj) => targetObject = obj as MonoBehaviour ??
            throw new NotSupportedException("The double edits scripts only.");

        public Object targetObject { get; }

        /// <summary>Paths of fields within fields have dots; of arrays there are none.</summary>
        public SerializedProperty FindProperty(string propertyPath)
        {
            _ = Read(propertyPath);
            return new SerializedProperty(this, propertyPath);
        }

        public void Update() => _changes.Clear();

        /// <summary>One step of Undo. Whether there was a change.</summary>
        public bool ApplyModifiedProperties()
        {
            if (_changes.Count == 0)
                return false;
            Undo.RecordObject(targetObject, "Edit");
            foreach (KeyValuePair<string, object> change in _changes)
            {
                FieldInfo field = Find(change.Key, out object owner);
                object value = field.FieldType.IsEnum ? Enum.ToObject(field.FieldType, change.Value) : change.Value;
                field.SetValue(owner, value);
            }
            _changes.Clear();
            SerializedFields.Validate(targetObject);
            EditorUtility.SetDirty(targetObject);
            EditorApplication.QueuePlayerLoopUpdate(); // the scene is drawn again
            return true;
        }

        public void Dispose()
        {
        }

        internal object Read(string path) =>
            _changes.TryGetValue(path, out object changed) ? changed : Find(path, out object owner).GetValue(owner);

        internal void Write(string path, object value)
        {
            if (!Equals(value, Read(path)))
                _changes[path] = value;
        }

        private FieldInfo Find(string path, out object owner)
        {
            owner = targetObject;
            string[] names = path.Split('.');
            for (int k = 0; k < names.Length - 1; ++k)
                owner = SerializedFields.Find(owner.GetType(), names[k]).GetValue(owner);
            return SerializedFields.Find(owner.GetType(), names[names.Length - 1]);
        }
    }

    public class SerializedProperty
    {
        internal SerializedProperty(SerializedObject owner, string path) => (serializedObject, propertyPath) = (owner, path);

        public SerializedObject serializedObject { get; }

        public string propertyPath { get; }

        public int intValue
        {
            get => Convert.ToInt32(serializedObject.Read(propertyPath));
            set => serializedObject.Write(propertyPath, value);
        }

        public float floatValue
        {
            get => (float)serializedObject.Read(propertyPath);
            set => serializedObject.Write(propertyPath, value);
        }

        public string stringValue
        {
            get => (string)serializedObject.Read(propertyPath);
            set => serializedObject.Write(propertyPath, value);
        }

        public Object objectReferenceValue
        {
            get => (Object)serializedObject.Read(propertyPath);
            set => serializedObject.Write(propertyPath, value);
        }

        public SerializedProperty FindPropertyRelative(string relativePropertyPath) =>
            serializedObject.FindProperty(propertyPath + "." + relativePropertyPath);
    }
}
