// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using UnityEngine;

namespace QuickSes
{
    /// <summary>Colours of atoms from what a file says about them. Any thread.</summary>
    public static class AtomColors
    {
        /// <summary>Fills in a colour per atom (sRGB).</summary>
        /// <param name="structure">N atoms.</param>
        /// <param name="scheme">What the colours tell.</param>
        /// <param name="uniform">
        /// For <see cref="AtomColorScheme.Uniform"/>, and for atoms of which the scheme tells nothing, such as those of
        /// ligands in the schemes of residues.
        /// </param>
        /// <param name="colors">Room for N or more.</param>
        public static void Fill(Structure structure, AtomColorScheme scheme, Color32 uniform, Span<Color32> colors)
        {
            if (structure == null)
                throw new ArgumentNullException(nameof(structure));
            Span<Color32> one = stackalloc Color32[] { uniform };
            structure.FillColors(scheme, MemoryMarshal.AsBytes(one), MemoryMarshal.AsBytes(colors));
        }
    }
}
