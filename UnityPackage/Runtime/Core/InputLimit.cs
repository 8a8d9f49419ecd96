// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// How many bytes <see cref="Structure"/> and <see cref="Trajectory"/> take into memory from one file or buffer,
    /// unpacked: a gzip file of 3 MB can hold 3 GB.
    /// </summary>
    public static class InputLimit
    {
        /// <summary>
        /// Holds for the whole process from now on; a larger file gives an error. 0 (default): 4 GiB, but of gzip data
        /// at most 100 times its size or 256 MiB, whichever is larger. Any other number holds for all alike. Frames that
        /// stay in their file (not gzipped, and not PDB), and plain bytes that are given in memory, are not counted.
        /// </summary>
        public static void Set(long bytes)
        {
            if (bytes < 0)
                throw new ArgumentOutOfRangeException(nameof(bytes), bytes, "it can't be negative");
            NativeLibraryCheck.ThrowIfUnusable();
            NativeMethods.qses_input_set_limit((ulong)bytes);
        }
    }
}
