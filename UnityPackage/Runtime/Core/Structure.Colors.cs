// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    public sealed unsafe partial class Structure
    {
        /// <summary>Fills in a colour per atom: red, green, blue, alpha (sRGB). Makes no garbage.</summary>
        /// <param name="scheme">What the colours tell.</param>
        /// <param name="uniform">
        /// Four bytes, for <see cref="AtomColorScheme.Uniform"/>, and for atoms of which the scheme tells nothing, such
        /// as those of ligands in the schemes of residues.
        /// </param>
        /// <param name="rgba">Room for 4 N bytes or more.</param>
        public void FillColors(AtomColorScheme scheme, ReadOnlySpan<byte> uniform, Span<byte> rgba)
        {
            if (scheme < AtomColorScheme.Uniform || scheme > AtomColorScheme.Sequence)
                throw new ArgumentOutOfRangeException(nameof(scheme), scheme, "there is no such scheme");
            if (uniform.Length != 4)
                throw new ArgumentException($"has {uniform.Length} bytes instead of 4", nameof(uniform));
            if (rgba.Length / 4 < AtomCount)
                throw new ArgumentException($"has room for {rgba.Length / 4} of {AtomCount} colors", nameof(rgba));
            fixed (byte* color = uniform)
            fixed (byte* colors = rgba)
                QuickSesException.ThrowUnlessOk(
                    NativeMethods.qses_structure_colors(_handle, scheme, color, colors, (UIntPtr)AtomCount));
        }
    }
}
