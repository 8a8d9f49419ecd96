// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;

namespace QuickSes.EngineDouble
{
    /// <summary>What the Editor finds by reflection.</summary>
    internal static class Methods
    {
        private const BindingFlags Static =
            BindingFlags.DeclaredOnly | BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic;

        /// <summary>Types of all assemblies that know the Editor.</summary>
        public static IEnumerable<Type> Types => AppDomain.CurrentDomain.GetAssemblies()
            .Where(assembly => assembly.GetReferencedAssemblies().Any(
                name => name.Name == typeof(Methods).Assembly.GetName().Name))
            .SelectMany(assembly => assembly.GetTypes());

        public static IEnumerable<(MethodInfo, T)> With<T>(Assembly assembly) where T : Attribute =>
            With<T>(assembly.GetTypes());

        public static IEnumerable<(MethodInfo, T)> With<T>(IEnumerable<Type> types) where T : Attribute =>
            from type in types
            from method in type.GetMethods(Static)
            let attribute = method.GetCustomAttribute<T>()
            where attribute != null
            select (method, attribute);

        public static MethodInfo Find(Type type, string name) => type.GetMethod(name, Static);
    }
}
