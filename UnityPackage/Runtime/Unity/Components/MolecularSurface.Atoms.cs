// SPDX-License-Identifier: MIT
// The atoms of a surface and their appearance. Everything is copied during the call; wrong lengths throw
// ArgumentException and leave all as it was. What is wrong with single atoms (a position that is not a number, a radius
// out of range) is told by Failed.
using System;
using System.Runtime.InteropServices;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        /// <summary>
        /// Where atoms come from if no script gives them; after a change call <see
        /// cref="BeginLoadSource"/>.
        /// </summary>
        public MoleculeSource Source => _source;

        /// <summary>How many atoms there are.</summary>
        public int AtomCount => Session.Atoms.Count;

        /// <summary>
        /// Where they are, as they were set last, in Å and Unity's axes, before the transform. Valid until they change.
        /// </summary>
        public ReadOnlySpan<Vector3> Positions =>
            MemoryMarshal.Cast<System.Numerics.Vector3, Vector3>(Session.Atoms.Positions);

        /// <summary>
        /// Gives the surface its atoms. With the same radii as before it is <see cref="SetPositions(Vector3[])"/>; with
        /// another number of atoms colours, visibility and texture coordinates go.
        /// </summary>
        /// <param name="positions">N, in Å, Unity's axes, within 1e6 Å of the origin. N may be 0.</param>
        /// <param name="radii">N van der Waals radii in Å, above 0 and at most 100.</param>
        public void SetAtoms(ReadOnlySpan<Vector3> positions, ReadOnlySpan<float> radii)
        {
            TakeAtoms(positions, radii);
            _isScriptFed = true;
        }

        /// <inheritdoc cref="SetAtoms(ReadOnlySpan{Vector3}, ReadOnlySpan{float})"/>
        public void SetAtoms(Vector3[] positions, float[] radii) =>
            SetAtoms(NotNull(positions, nameof(positions)), NotNull(radii, nameof(radii)));

        /// <summary>The same from the first <paramref name="count"/> elements of longer arrays.</summary>
        public void SetAtoms(Vector3[] positions, float[] radii, int count) => SetAtoms(
            SurfaceArrays.First(positions, count, nameof(positions)), SurfaceArrays.First(radii, count, nameof(radii)));

        /// <summary>The same from N x 3 numbers x, y, z.</summary>
        public void SetAtoms(float[] xyz, float[] radii) =>
            SetAtoms(Vectors(xyz, nameof(xyz)), NotNull(radii, nameof(radii)));

        /// <summary>The same from native arrays, which are only read during the call.</summary>
        public void SetAtoms(NativeArray<Vector3> positions, NativeArray<float> radii) =>
            SetAtoms(Span(positions), Span(radii));

        /// <summary>New positions for the atoms, for instance the next frame of a trajectory.</summary>
        /// <param name="positions">N, in Å, Unity's axes.</param>
        public void SetPositions(ReadOnlySpan<Vector3> positions)
        {
            Session.Atoms.SetPositions(Numbers(positions));
            Changed(SurfaceChange.Positions);
        }

        /// <inheritdoc cref="SetPositions(ReadOnlySpan{Vector3})"/>
        public void SetPositions(Vector3[] positions) => SetPositions(NotNull(positions, nameof(positions)));

        /// <summary>The same from N x 3 numbers x, y, z.</summary>
        public void SetPositions(float[] xyz) => SetPositions(Vectors(xyz, nameof(xyz)));

        /// <summary>The same from a native array, which is only read during the call.</summary>
        public void SetPositions(NativeArray<Vector3> positions) => SetPositions(Span(positions));

        /// <summary>New positions, picked out of a larger array: atom i is at frame[indices[i]].</summary>
        /// <param name="frame">Such as the positions of all atoms of a simulation.</param>
        /// <param name="indices">N.</param>
        public void SetPositions(ReadOnlySpan<Vector3> frame, ReadOnlySpan<int> indices)
        {
            Session.Atoms.SetPositions(Numbers(frame), indices);
            Changed(SurfaceChange.Positions);
        }

        /// <inheritdoc cref="SetPositions(ReadOnlySpan{Vector3}, ReadOnlySpan{int})"/>
        public void SetPositions(Vector3[] frame, int[] indices) =>
            SetPositions(NotNull(frame, nameof(frame)), NotNull(indices, nameof(indices)));

        /// <inheritdoc cref="SetPositions(ReadOnlySpan{Vector3}, ReadOnlySpan{int})"/>
        public void SetPositions(NativeArray<Vector3> frame, NativeArray<int> indices) =>
            SetPositions(Span(frame), Span(indices));

        /// <summary>Colours of the atoms, which go to the vertices they own.</summary>
        /// <param name="colors">N; empty: <see cref="BaseColor"/> for all.</param>
        public void SetColors(ReadOnlySpan<Color32> colors)
        {
            Session.Atoms.SetColors(Numbers(colors));
            LookChanged();
        }

        /// <inheritdoc cref="SetColors(ReadOnlySpan{Color32})"/>
        public void SetColors(Color32[] colors) => SetColors(NotNull(colors, nameof(colors)));

        /// <summary>Texture coordinate 1 of the atoms, for their vertices.</summary>
        /// <param name="texcoords">
        /// N; empty: the mesh has none, or <see cref="AmbientOcclusion"/>. The package's shaders take x for occlusion, from
        /// 0 (closed in) to 1 (open), and 0, 0 for a mesh without: let y be 1.
        /// </param>
        public void SetTexcoords(ReadOnlySpan<Vector2> texcoords)
        {
            Session.Atoms.SetTexcoords(MemoryMarshal.Cast<Vector2, System.Numerics.Vector2>(texcoords));
            LookChanged();
        }

        /// <inheritdoc cref="SetTexcoords(ReadOnlySpan{Vector2})"/>
        public void SetTexcoords(Vector2[] texcoords) => SetTexcoords(NotNull(texcoords, nameof(texcoords)));

        /// <summary>No atoms and no surface, until there are new ones.</summary>
        public void ClearAtoms()
        {
            Clear();
            CancelLoading();
            _isScriptFed = true;
        }

        // Of a script, a file or a player.
        private void TakeAtoms(ReadOnlySpan<Vector3> positions, ReadOnlySpan<float> radii)
        {
            LeaveEditMode(); // who is enabled earlier may set atoms before this is
            bool haveMoved = Session.Atoms.SetAtoms(Numbers(positions), radii);
            CancelLoading();
            if (!haveMoved)
                LoseStructure();
            Changed(haveMoved ? SurfaceChange.Positions : SurfaceChange.Shape);
        }

        private void Clear()
        {
            LoseStructure();
            Session.Clear();
            Mesh onGpu = Shown.IsOnGpu ? Shown.Mesh : null;
            Shown.Clear();
            ForgetOwners();
            if (onGpu is null)
                return;
            FollowMesh(onGpu);
            FollowBounds();
        }

        // The session knows nothing of the engine; the numbers are the same.
        private static ReadOnlySpan<System.Numerics.Vector3> Numbers(ReadOnlySpan<Vector3> vectors) =>
            MemoryMarshal.Cast<Vector3, System.Numerics.Vector3>(vectors);

        private static ReadOnlySpan<uint> Numbers(ReadOnlySpan<Color32> colors) =>
            MemoryMarshal.Cast<Color32, uint>(colors);

        private static unsafe uint Number(Color32 color) => *(uint*)&color;

        private static ReadOnlySpan<T> NotNull<T>(T[] array, string argument) =>
            array ?? throw new ArgumentNullException(argument);

        private static ReadOnlySpan<Vector3> Vectors(float[] xyz, string argument)
        {
            if (NotNull(xyz, argument).Length % 3 != 0)
                throw new ArgumentException($"has {xyz.Length} numbers, which is not three per atom", argument);
            return MemoryMarshal.Cast<float, Vector3>(xyz);
        }

        private static unsafe ReadOnlySpan<T> Span<T>(NativeArray<T> array) where T : unmanaged =>
            new ReadOnlySpan<T>(array.Length == 0 ? null : array.GetUnsafeReadOnlyPtr(), array.Length);
    }
}
