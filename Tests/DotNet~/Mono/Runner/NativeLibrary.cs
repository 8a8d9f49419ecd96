// SPDX-License-Identifier: MIT
// What the tests use of .NET and netstandard2.1 has not.
using System.Reflection;

namespace System.Runtime.InteropServices
{
    internal delegate IntPtr DllImportResolver(string name, Assembly assembly, DllImportSearchPath? searchPath);

    /// <summary>
    /// Libraries by dlopen. Mono has no resolvers: QuickSes.Core.dll.config lets it look for the native library's functions
    /// among those that are visible to the whole program, and the library that a resolver gives is made visible.
    /// </summary>
    internal static class NativeLibrary
    {
        private const int Now = 2, NoLoad = 4, Global = 0x100;

        public static IntPtr Load(string path)
        {
            IntPtr library = dlopen(path, Now);
            return library != IntPtr.Zero
                ? library
                : throw new DllNotFoundException(Marshal.PtrToStringAnsi(dlerror()));
        }

        public static IntPtr GetExport(IntPtr library, string name) =>
            TryGetExport(library, name, out IntPtr address) ? address : throw new EntryPointNotFoundException(name);

        public static bool TryGetExport(IntPtr library, string name, out IntPtr address)
        {
            address = dlsym(library, name);
            return address != IntPtr.Zero;
        }

        public static void SetDllImportResolver(Assembly assembly, DllImportResolver resolve)
        {
            IntPtr library = resolve("quickses", assembly, null);
            // glibc's handle is its struct link_map, whose second member is the name that it was loaded by.
            string name = Marshal.PtrToStringAnsi(Marshal.ReadIntPtr(library, IntPtr.Size));
            if (dlopen(name, Now | NoLoad | Global) != library)
                throw new DllNotFoundException($"{name} can't be made visible");
        }

        [DllImport("libdl.so.2")]
        private static extern IntPtr dlopen(string path, int mode);

        [DllImport("libdl.so.2")]
        private static extern IntPtr dlsym(IntPtr library, string name);

        [DllImport("libdl.so.2")]
        private static extern IntPtr dlerror();
    }
}
