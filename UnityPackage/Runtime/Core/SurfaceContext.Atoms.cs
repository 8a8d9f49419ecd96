// SPDX-License-Identifier: MIT
// The atoms of a context and their appearance.
using QuickSes.Interop;
using System;

namespace QuickSes
{
    public sealed partial class SurfaceContext
    {
        /// <summary>Atoms of the last <see cref="SetAtoms"/> that succeeded.</summary>
        public int AtomCount { get; private set; }

        /// <summary>
        /// Gives the context its atoms; everything is copied. A job that runs keeps what it was begun with. Colours,
        /// texture coordinates and visibility go if the number of atoms changes.
        /// </summary>
        /// <param name="positions">N x 3: x, y, z in Å, within 1e6 Å of the origin. N may be 0: an empty mesh.</param>
        /// <param name="radii">N van der Waals radii in Å, above 0 and at most 100.</param>
        /// <returns>Ok, OutOfMemory or DeviceError.</returns>
        public unsafe QuickSesStatus SetAtoms(ReadOnlySpan<float> positions, ReadOnlySpan<float> radii)
        {
            ThrowIfDisposed();
            ThrowUnlessPerAtom(positions.Length, 3, radii.Length, nameof(positions));
            QuickSesStatus status;
            fixed (float* xyz = positions, r = radii)
                status = NativeMethods.qses_set_atoms(_handle, xyz, UIntPtr.Zero, r, (UIntPtr)radii.Length);
            if (status == QuickSesStatus.Ok)
                AtomCount = radii.Length;
            return Check(status);
        }

        /// <summary>
        /// New positions for the same atoms, for instance the next frame of a trajectory; radii stay.
        /// </summary>
        /// <param name="positions">N x 3, Å.</param>
        /// <returns>Ok, OutOfMemory or DeviceError.</returns>
        public unsafe QuickSesStatus SetPositions(ReadOnlySpan<float> positions)
        {
            ThrowIfDisposed();
            ThrowUnlessPerAtom(positions.Length, 3, AtomCount, nameof(positions));
            fixed (float* xyz = positions)
                return Check(NativeMethods.qses_set_positions(_handle, xyz, UIntPtr.Zero, (UIntPtr)AtomCount));
        }

        /// <summary>New positions, picked out of a larger array: atom i is at position indices[i].</summary>
        /// <param name="positions">M x 3, Å, such as a whole frame of a trajectory.</param>
        /// <param name="indices">N, each below M, such as <see cref="Structure.FileIndices"/>.</param>
        /// <returns>Ok, OutOfMemory or DeviceError.</returns>
        public unsafe QuickSesStatus SetPositions(ReadOnlySpan<float> positions, ReadOnlySpan<uint> indices)
        {
            ThrowIfDisposed();
            ThrowUnlessPerAtom(indices.Length, 1, AtomCount, nameof(indices));
            if (positions.Length % 3 != 0)
                throw new ArgumentException($"has {positions.Length} numbers, which is not three per atom",
                    nameof(positions));
            fixed (float* xyz = positions)
            fixed (uint* picked = indices)
                return Check(NativeMethods.qses_set_positions_indexed(_handle, xyz, UIntPtr.Zero,
                    (UIntPtr)(positions.Length / 3), picked, (UIntPtr)indices.Length));
        }

        /// <summary>
        /// Which atoms are shown: N of 1 or 0; empty: all. The surface is that of all atoms; triangles with a vertex of
        /// a hidden one are dropped.
        /// </summary>
        /// <returns>Ok or OutOfMemory.</returns>
        public unsafe QuickSesStatus SetVisible(ReadOnlySpan<byte> visible)
        {
            ThrowIfDisposed();
            if (!visible.IsEmpty)
                ThrowUnlessPerAtom(visible.Length, 1, AtomCount, nameof(visible));
            fixed (byte* mask = visible)
                return Check(NativeMethods.qses_set_visible(_handle, mask, (UIntPtr)AtomCount));
        }

        /// <summary>Colours of the atoms, for their vertices: N x 4, red, green, blue, alpha; empty: none.</summary>
        /// <returns>Ok or OutOfMemory.</returns>
        public unsafe QuickSesStatus SetColors(ReadOnlySpan<byte> rgba)
        {
            ThrowIfDisposed();
            if (!rgba.IsEmpty)
                ThrowUnlessPerAtom(rgba.Length, 4, AtomCount, nameof(rgba));
            fixed (byte* colors = rgba)
                return Check(NativeMethods.qses_set_colors(_handle, colors, (UIntPtr)AtomCount));
        }

        /// <summary>
        /// Texture coordinates of the atoms, for their vertices (<see cref="SurfaceSettings.Texcoords"/>): N x 2;
        /// empty: 1, 0 for all.
        /// </summary>
        /// <returns>Ok or OutOfMemory.</returns>
        public unsafe QuickSesStatus SetTexcoords(ReadOnlySpan<float> uv)
        {
            ThrowIfDisposed();
            if (!uv.IsEmpty)
                ThrowUnlessPerAtom(uv.Length, 2, AtomCount, nameof(uv));
            fixed (float* texcoords = uv)
                return Check(NativeMethods.qses_set_texcoords(_handle, texcoords, (UIntPtr)AtomCount));
        }

        private static void ThrowUnlessPerAtom(int length, int perAtom, int atomCount, string argument)
        {
            if (length != (long)perAtom * atomCount)
                throw new ArgumentException($"has {length} numbers, but {atomCount} atoms need {perAtom} each",
                    argument);
        }
    }
}
