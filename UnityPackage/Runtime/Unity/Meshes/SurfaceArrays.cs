// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// The engine's arrays in and out of <see cref="SurfaceContext"/>, for programs that use it without
    /// <see cref="MolecularSurface"/>. Arrays may be longer than what is used of them: counts are given. No garbage.
    /// Threads, errors and results are those of the methods of the same name that take spans. Copies are of meshes in host
    /// memory: of one that is not (<see cref="SurfaceMeshView.IsInHostMemory"/>) they throw InvalidOperationException.
    /// </summary>
    public static class SurfaceArrays
    {
        /// <summary>Gives the context its atoms: the first <paramref name="count"/> of the arrays, in Å.</summary>
        public static QuickSesStatus SetAtoms(
            this SurfaceContext context, Vector3[] positions, float[] radii, int count) =>
            context.SetAtoms(Floats(First(positions, count, nameof(positions))), First(radii, count, nameof(radii)));

        /// <summary>New positions for the atoms: the first <paramref name="count"/> of the array, in Å.</summary>
        public static QuickSesStatus SetPositions(this SurfaceContext context, Vector3[] positions, int count) =>
            context.SetPositions(Floats(First(positions, count, nameof(positions))));

        /// <summary>
        /// New positions, picked: atom i is at frame[indices[i]], for i below <paramref name="count"/>.
        /// </summary>
        public static QuickSesStatus SetPositions(
            this SurfaceContext context, Vector3[] frame, int[] indices, int count) =>
            context.SetPositions(Floats(frame), MemoryMarshal.Cast<int, uint>(First(indices, count, nameof(indices))));

        /// <summary>Colours of the atoms: the first <paramref name="count"/> of the array.</summary>
        public static QuickSesStatus SetColors(this SurfaceContext context, Color32[] colors, int count) =>
            context.SetColors(MemoryMarshal.AsBytes(First(colors, count, nameof(colors))));

        /// <summary>Copies positions, V of them, in Å. Throws if the array is shorter.</summary>
        public static void CopyPositions(this in SurfaceMeshView view, Vector3[] positions)
        {
            Span<Vector3> room = Room(view, positions, view.VertexCount, nameof(positions));
            if (view.VertexLayout != SurfaceVertexLayout.Separate)
                CopyStrided(view, 0, room);
            else
                MemoryMarshal.Cast<float, Vector3>(view.Positions).CopyTo(room);
        }

        /// <summary>Copies normals, V of them. Throws if the array is shorter.</summary>
        public static unsafe void CopyNormals(this in SurfaceMeshView view, Vector3[] normals)
        {
            Span<Vector3> room = Room(view, normals, view.VertexCount, nameof(normals));
            if (view.VertexLayout == SurfaceVertexLayout.Interleaved)
                CopyStrided(view, sizeof(Vector3), room);
            else if (view.VertexLayout == SurfaceVertexLayout.Compact)
                CopyCompactNormals(view, room);
            else
                MemoryMarshal.Cast<float, Vector3>(view.Normals).CopyTo(room);
        }

        /// <summary>Copies colours, V of them; white if the atoms have none. Throws if the array is shorter.</summary>
        public static void CopyColors(this in SurfaceMeshView view, Color32[] colors)
        {
            Span<Color32> room = Room(view, colors, view.VertexCount, nameof(colors));
            if (view.HasColors)
                MemoryMarshal.Cast<byte, Color32>(view.Colors).CopyTo(room);
            else
                room.Fill(new Color32(255, 255, 255, 255));
        }

        /// <summary>Copies the vertex numbers of triangles, 3 T of them. Throws if the array is shorter.</summary>
        public static void CopyTriangles(this in SurfaceMeshView view, int[] triangles) =>
            MemoryMarshal.Cast<uint, int>(view.Indices)
                .CopyTo(Room(view, triangles, checked(3 * view.TriangleCount), nameof(triangles)));

        /// <summary>
        /// Copies the atom of each vertex, V of them: 0-based, in the order the atoms were given, always in range.
        /// Throws if the array is shorter.
        /// </summary>
        public static void CopyOwners(this in SurfaceMeshView view, int[] atoms) =>
            MemoryMarshal.Cast<uint, int>(view.Owners).CopyTo(Room(view, atoms, view.VertexCount, nameof(atoms)));

        internal static ReadOnlySpan<float> Floats(ReadOnlySpan<Vector3> vectors) =>
            MemoryMarshal.Cast<Vector3, float>(vectors);

        internal static ReadOnlySpan<T> First<T>(T[] array, int count, string argument)
        {
            if (array == null)
                throw new ArgumentNullException(argument);
            if (count < 0 || count > array.Length)
                throw new ArgumentOutOfRangeException(nameof(count), count,
                    $"{argument} has {array.Length} elements");
            return new ReadOnlySpan<T>(array, 0, count);
        }

        /// <summary>Whoever reads a mesh's memory says so first: where there is none, nothing would be read, or null.</summary>
        internal static void ThrowUnlessInHostMemory(in SurfaceMeshView view)
        {
            if (!view.IsInHostMemory)
                throw new InvalidOperationException("The mesh is not in host memory: compute it with Delivery = " +
                    "MeshDelivery.Host. One on a CUDA device can be kept (SurfaceContext.Keep) and brought by KeptMesh.Download.");
        }

        private static Span<T> Room<T>(in SurfaceMeshView view, T[] array, int count, string argument)
        {
            ThrowUnlessInHostMemory(view);
            if (array == null)
                throw new ArgumentNullException(argument);
            if (array.Length < count)
                throw new ArgumentException($"has room for {array.Length} elements, but there are {count}", argument);
            return new Span<T>(array, 0, count);
        }

        private static unsafe void CopyCompactNormals(in SurfaceMeshView view, Span<Vector3> target)
        {
            sbyte* normal = (sbyte*)view.PositionsPointer + sizeof(Vector3);
            for (int v = 0; v < target.Length; ++v, normal += view.VertexBytes)
                target[v] = new Vector3(normal[0], normal[1], normal[2]) / 127;
        }

        // One attribute of interleaved vertices, `offset` bytes from the beginning of each.
        private static unsafe void CopyStrided<T>(in SurfaceMeshView view, int offset, Span<T> target)
            where T : unmanaged
        {
            byte* vertex = (byte*)view.PositionsPointer + offset;
            for (int v = 0; v < target.Length; ++v, vertex += view.VertexBytes)
                target[v] = *(T*)vertex;
        }
    }
}
