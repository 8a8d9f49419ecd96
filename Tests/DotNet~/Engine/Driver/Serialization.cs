// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    /// <summary>Which types the engine serialises as fields of scripts.</summary>
    internal static class Serialization
    {
        /// <summary>What a field has that was null when it was serialised.</summary>
        public static object EmptyValue(Type type)
        {
            if (type == typeof(string))
                return "";
            if (type.IsArray)
                return Array.CreateInstance(type.GetElementType(), 0);
            return typeof(Object).IsAssignableFrom(type) ? null : Activator.CreateInstance(type, true);
        }

        /// <summary>Those of a type itself that are serialised.</summary>
        public static IEnumerable<FieldInfo> FieldsOf(Type type)
        {
            const BindingFlags declared =
                BindingFlags.DeclaredOnly | BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
            foreach (FieldInfo field in type.GetFields(declared))
                if (!field.IsInitOnly && !field.IsNotSerialized && IsSerializable(field.FieldType) &&
                    (field.IsPublic || field.IsDefined(typeof(SerializeField), false)))
                    yield return field;
        }

        public static bool IsSerializable(Type type)
        {
            if (type.IsArray)
                return type.GetArrayRank() == 1 && IsSerializableElement(type.GetElementType());
            if (type.IsGenericType && type.GetGenericTypeDefinition() == typeof(List<>))
                return IsSerializableElement(type.GetGenericArguments()[0]);
            return IsSerializableElement(type);
        }

        /// <summary>Whether a type's fields are serialised one by one, inside the object that has it.</summary>
        public static bool IsInline(Type type) => !type.IsPrimitive && !type.IsEnum && type != typeof(string) &&
            !IsEngineStruct(type) && !typeof(Object).IsAssignableFrom(type);

        // Lists of lists and the like are not serialised.
        private static bool IsSerializableElement(Type type)
        {
            if (type.IsPrimitive)
                return type != typeof(IntPtr) && type != typeof(UIntPtr);
            if (type.IsEnum || type == typeof(string) || typeof(Object).IsAssignableFrom(type))
                return true;
            return (IsEngineStruct(type) || type.IsDefined(typeof(SerializableAttribute), false)) &&
                !type.IsAbstract && !type.IsArray && !typeof(Delegate).IsAssignableFrom(type) &&
                type.Assembly != typeof(string).Assembly;
        }

        private static bool IsEngineStruct(Type type) =>
            type.IsValueType && type.Assembly == typeof(Vector3).Assembly;
    }
}
