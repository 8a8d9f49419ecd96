// SPDX-License-Identifier: MIT
using System;
using System.Reflection;
using UnityEngine;

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
                    bool survives = !field.IsInitOnly && !field.IsNotSerialized &&
                        Serialization.IsSerializable(field.FieldType);
                    if (survives && field.GetValue(script) != null)
                        continue;
                    if (!survives && fresh is null)
                        fresh = (MonoBehaviour)Activator.CreateInstance(script.GetType(), true);
                    field.SetValue(script,
                        survives ? Serialization.EmptyValue(field.FieldType) : field.GetValue(fresh));
                }
            }

            if (!(fresh is null))
                ObjectRegistry.Remove(fresh);
        }
    }
}
