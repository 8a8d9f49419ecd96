// SPDX-License-Identifier: MIT
using Mono.Cecil;
using Mono.Cecil.Cil;
using System;
using System.IO;
using System.Linq;

namespace QuickSes.MonoPatch
{
    /// <summary>
    /// patch FOLDER...: in the package's assemblies and those of its tests, takes the modifier "in" (modreq InAttribute) from
    /// the results of Span's and ReadOnlySpan's methods where they are called. netstandard2.1 and Unity's Mono have it on ReadOnlySpan's indexer, Debian's mscorlib
    /// has not, and without this each such call is a MissingMethodException there.
    /// </summary>
    internal static class Program
    {
        private static void Main(string[] folders)
        {
            foreach (string file in folders.SelectMany(folder => Directory.GetFiles(folder, "*.dll")))
            {
                if (!IsOurs(Path.GetFileName(file)))
                    continue;
                using var resolver = new DefaultAssemblyResolver();
                resolver.AddSearchDirectory(Path.GetDirectoryName(Path.GetFullPath(file)));
                var how = new ReaderParameters { InMemory = true, AssemblyResolver = resolver };
                using ModuleDefinition module = ModuleDefinition.ReadModule(file, how);
                if (Patch(module) > 0)
                    module.Write(file);
            }
        }

        private static bool IsOurs(string name) =>
            name.StartsWith("QuickSes.", StringComparison.Ordinal) ||
            name.StartsWith("UnityEngine.Double.", StringComparison.Ordinal);

        private static int Patch(ModuleDefinition module)
        {
            int count = 0;
            foreach (MethodDefinition method in module.GetTypes().SelectMany(type => type.Methods))
            {
                if (!method.HasBody)
                    continue;
                foreach (Instruction instruction in method.Body.Instructions)
                {
                    if (instruction.Operand is MethodReference called && IsOfSpan(called.DeclaringType) &&
                        called.ReturnType is RequiredModifierType modified)
                    {
                        called.ReturnType = modified.ElementType;
                        ++count;
                    }
                }
            }
            return count;
        }

        private static bool IsOfSpan(TypeReference type) =>
            type.FullName.StartsWith("System.ReadOnlySpan`1", StringComparison.Ordinal) ||
            type.FullName.StartsWith("System.Span`1", StringComparison.Ordinal);
    }
}
