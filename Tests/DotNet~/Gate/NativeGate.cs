// SPDX-License-Identifier: MIT
using System;
using System.IO;
using System.Runtime.InteropServices;

/// <summary>
/// A native library before the one under test, in which calls that may start CUDA wait while it is closed: see gate.c.
/// </summary>
public sealed partial class NativeLibrarySetup
{
    static partial void PutBefore(ref IntPtr library)
    {
        string gate = Path.Combine(Path.GetTempPath(), $"quickses-gate-{Guid.NewGuid():N}.so");
        string source = Path.Combine(Repository.Root, "Tests", "DotNet~", "Gate", "gate.c");
        string include = Path.Combine(Repository.Root, "NativePlugin", "Source~", "include");
        Repository.Run(Environment.GetEnvironmentVariable("CC") ?? "cc",
            $"-shared -fPIC -DQSES_STATIC \"-I{include}\" \"{source}\" -Wl,--no-as-needed \"{LibraryPath}\" " +
            $"-o \"{gate}\" \"-Wl,-rpath,{Path.GetDirectoryName(LibraryPath)}\"");
        library = NativeLibrary.Load(gate);
        File.Delete(gate);
        NativeGate.Library = library;
    }
}

/// <summary>Main thread only.</summary>
internal static class NativeGate
{
    internal static IntPtr Library;

    private delegate void Act();

    private delegate int Count();

    /// <summary>Threads that wait.</summary>
    public static int Waiting => Find<Count>("gate_waiting")();

    /// <summary>Calls that may start CUDA wait from now on; those of this thread are counted.</summary>
    public static void Close() => Find<Act>("gate_close")();

    /// <summary>qses_backend_info says from now on that a GPU is prepared.</summary>
    public static void Prepare() => Find<Act>("gate_prepare")();

    /// <returns>How many calls of the thread that closed it would have waited.</returns>
    public static int Open() => Find<Count>("gate_open")();

    private static T Find<T>(string function) where T : Delegate =>
        Marshal.GetDelegateForFunctionPointer<T>(NativeLibrary.GetExport(Library, function));
}
