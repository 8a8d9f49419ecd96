// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes;
using System;
using System.IO;
using System.Reflection;
using System.Runtime.InteropServices;

/// <summary>Loads the library under test: $QUICKSES_NATIVE (a path), else that of the preset cpu.</summary>
[SetUpFixture]
public sealed partial class NativeLibrarySetup
{
    private static IntPtr s_library;

    public static string LibraryPath => Environment.GetEnvironmentVariable("QUICKSES_NATIVE") ??
                                        Path.Combine(Repository.Root, ".build", "cpu", "lib", "libquickses.so");

    public static IntPtr Library => s_library;

    [OneTimeSetUp]
    public void LoadLibrary()
    {
        if (!File.Exists(LibraryPath))
            throw new FileNotFoundException(
                $"No native library at {LibraryPath}: build it (cmake --preset cpu && cmake --build --preset cpu), " +
                "or give its path in QUICKSES_NATIVE.");
        s_library = NativeLibrary.Load(LibraryPath);
        PutBefore(ref s_library);
        NativeLibrary.SetDllImportResolver(typeof(SurfaceContext).Assembly, Resolve);
    }

    /// <summary>For tests that want another library between them and the one under test.</summary>
    static partial void PutBefore(ref IntPtr library);

    private static IntPtr Resolve(string name, Assembly assembly, DllImportSearchPath? searchPath) =>
        name == "quickses" ? s_library : IntPtr.Zero;
}
