// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using QuickSes.Tests;
using System;
using System.Globalization;
using System.IO;
using System.Reflection;
using System.Runtime.InteropServices;

namespace QuickSes.Playback
{
    /// <summary>
    /// playback LIBRARY frames FILE COUNT: plays a trajectory until COUNT surfaces were shown; prints what that took.
    /// <para>playback LIBRARY many SURFACES COUNT: moves as many small surfaces at once; prints the same.</para>
    /// <para>playback LIBRARY cost FILE...: prints the milliseconds the main thread spends on a frame.</para>
    /// <para>playback LIBRARY device FILE...: the same for surfaces that stay on a GPU, of which there is a stand-in.</para>
    /// A process of its own, since test hosts allocate as they please on other threads.
    /// </summary>
    internal static class Program
    {
        private static int Main(string[] arguments)
        {
            if (arguments.Length < 3)
            {
                Console.Error.WriteLine("usage: playback LIBRARY frames FILE COUNT | playback LIBRARY many SURFACES " +
                    "COUNT | playback LIBRARY cost FILE... | playback LIBRARY device FILE...");
                return 2;
            }
            CultureInfo.DefaultThreadCurrentCulture = CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            IntPtr library = NativeLibrary.Load(arguments[0]);
            NativeLibrary.SetDllImportResolver(typeof(SurfaceContext).Assembly,
                (name, assembly, path) => name == "quickses" ? library : IntPtr.Zero);
            // Else the resolver is told the name, in a new string, when a function is called for the first time.
            Marshal.PrelinkAll(typeof(NativeMethods));
            if (arguments[1] == "frames")
                return LongPlay.Run(Path.GetFullPath(arguments[2]), int.Parse(arguments[3]));
            if (arguments[1] == "many")
            {
                ManySurfaces.Run(int.Parse(arguments[2]), int.Parse(arguments[3]));
                return 0;
            }
            for (int k = 2; k < arguments.Length; ++k)
                if (!FrameCost.TryPrint(Path.GetFullPath(arguments[k]), arguments[1] == "device" ? new StandInGpu() : null))
                    return 1;
            return 0;
        }
    }
}
