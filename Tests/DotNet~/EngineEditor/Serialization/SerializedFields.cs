// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    /// <summary>The serialised fields of a script, which the Editor writes, and then has it validate them.</summary>
    internal static class SerializedFields
    {
        /// <summary>What <see cref="Paste"/> takes.</summary>
        public static object Copy(MonoBehaviour script) => Values(script, script.GetType());

        public static void Paste(MonoBehaviour script, object state)
        {
            Write(script, (Dictionary<FieldInfo, object>)state);
            Validate(script);
        }

        public static void Validate(Object target)
        {
            if (target is MonoBehaviour script)
                MessageTable.Of(script.GetType()).Send(script, Message.OnValidate);
        }

        /// <summary>Of a field of the type, or of one that it is derived from.</summary>
        public static FieldInfo Find(Type type, string name)
        {
            for (; type != null; type = type.BaseType)
                foreach (FieldInfo field in Serialization.FieldsOf(type))
                    if (field.Name == name)
                        return field;
            throw new ArgumentException($"There is no serialised field {name}.");
        }

        // Objects that lie within the script by their fields, the rest by value.
        private static Dictionary<FieldInfo, object> Values(object from, Type type)
        {
            var values = new Dictionary<FieldInfo, object>();
            for (; type != typeof(MonoBehaviour) && type != typeof(object); type = type.BaseType)
                foreach (FieldInfo field in Serialization.FieldsOf(type))
                    values.Add(field, IsPart(field, field.GetValue(from))
                        ? Values(field.GetValue(from), field.FieldType)
                        : field.GetValue(from) is Array array ? array.Clone() : field.GetValue(from));
            return values;
        }

        private static void Write(object to, Dictionary<FieldInfo, object> values)
        {
            foreach (KeyValuePair<FieldInfo, object> pair in values)
                if (pair.Value is Dictionary<FieldInfo, object> part)
                    Write(pair.Key.GetValue(to), part);
                else
                    pair.Key.SetValue(to, pair.Value);
        }

        private static bool IsPart(FieldInfo field, object value) => value != null && field.FieldType.IsClass &&
            !field.FieldType.IsArray && !field.FieldType.IsGenericType && Serialization.IsInline(field.FieldType);
    }
}
