// SPDX-License-Identifier: MIT
using System;
using System.Globalization;
using System.Reflection;
using System.Runtime.InteropServices;

namespace QuickSes.Playback
{
    /// <summary>
    /// playback LIBRARY frames FILE COUNT     plays a trajectory until COUNT surfaces were shown; prints what was allocated
    /// playback LIBRARY cost FILE...          prints the milliseconds the main thread spends on a frame
    /// A process of its own, since test hosts allocate as they please on other threads.
    /// </summary>
    internal static class Program
    {
        private static int Main(string[] arguments)
        {
            if (arguments.Length < 3)
            {
                Console.Error.WriteLine("usage: playback LIBRARY frames FILE COUNT | playback LIBRARY cost FILE...");
                return 2;
            }
            CultureInfo.DefaultThreadCurrentCulture = CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
            IntPtr library = NativeLibrary.Load(arguments[0]);
            NativeLibrary.SetDllImportResolver(typeof(SurfaceContext).Assembly,
                (name, assembly, path) => name == "quickses" ? library : IntPtr.Zero);
            if (arguments[1] == "frames")
                return LongPlay.Run(arguments[2], int.Parse(arguments[3]));
            for (int k = 2; k < arguments.Length; ++k)
                FrameCost.Print(arguments[k]);
            return 0;
        }
    }
}
