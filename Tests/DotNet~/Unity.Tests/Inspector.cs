// SPDX-License-Identifier: MIT
using System.Reflection;

namespace QuickSes.Tests
{
    /// <summary>What the Editor does to a component whose serialised fields it has written.</summary>
    internal static class Inspector
    {
        private const BindingFlags Own = BindingFlags.Instance | BindingFlags.NonPublic;

        public static void Set(MolecularSurface surface, string field, object value)
        {
            Write(surface, field, value);
            Validate(surface);
        }

        /// <summary>As from a file, of which players tell nobody.</summary>
        public static void Write(MolecularSurface surface, string field, object value) =>
            typeof(MolecularSurface).GetField(field, Own).SetValue(surface, value);

        public static void Validate(MolecularSurface surface) =>
            typeof(MolecularSurface).GetMethod("OnValidate", Own).Invoke(surface, null);
    }
}
