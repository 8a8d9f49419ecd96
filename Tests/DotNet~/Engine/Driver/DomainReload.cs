// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What a reload of the domain does to the fields of a script. As in the Editor, private fields survive it, too, if
    /// their type can be serialised, and a null string, array or list comes back empty.
    /// </summary>
    internal static class DomainReload
    {
        private const BindingFlags Declared =
            BindingFlags.DeclaredOnly | BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;

        /// <summary>Fields that don't survive get what a new instance has.</summary>
        public static void ForgetFields(MonoBehaviour script)
        {
            MonoBehaviour fresh = null;
            for (Type type = script.GetType(); type != typeof(MonoBehaviour); type = type.BaseType)
            {
                foreach (FieldInfo field in type.GetFields(Declared))
                {
                    bool survives = !field.IsInitOnly && !field.IsNotSerialized && IsSerializable(field.FieldType, 0);
                    if (survives && field.GetValue(script) != null)
                        continue;
                    if (!survives && fresh is null)
                        fresh = (MonoBehaviour)Activator.CreateInstance(script.GetType(), true);
                    field.SetValue(script, survives ? EmptyValue(field.FieldType) : field.GetValue(fresh));
                }
            }

            if (!(fresh is null))
                ObjectRegistry.Remove(fresh);
        }

        private static object EmptyValue(Type type)
        {
            if (type == typeof(string))
                return "";
            if (type.IsArray)
                return Array.CreateInstance(type.GetElementType(), 0);
            return typeof(Object).IsAssignableFrom(type) ? null : Activator.CreateInstance(type, true);
        }

        private static bool IsSerializable(Type type, int depth)
        {
            const int DeepestNesting = 10;
            if (type.IsPrimitive)
                return type != typeof(IntPtr) && type != typeof(UIntPtr);
            if (type.IsEnum || type == typeof(string) || typeof(Object).IsAssignableFrom(type))
                return true;
            if (type.IsArray)
                return type.GetArrayRank() == 1 && !type.GetElementType().IsArray &&
                    IsSerializable(type.GetElementType(), depth);
            if (type.IsGenericType)
                return type.GetGenericTypeDefinition() == typeof(List<>) &&
                    IsSerializable(type.GetGenericArguments()[0], depth);
            bool isEngineStruct = type.IsValueType && type.Assembly == typeof(Vector3).Assembly;
            return (isEngineStruct || type.IsDefined(typeof(SerializableAttribute), false)) && !type.IsAbstract &&
                !typeof(Delegate).IsAssignableFrom(type) && type.Assembly != typeof(string).Assembly &&
                depth < DeepestNesting;
        }
    }
}
