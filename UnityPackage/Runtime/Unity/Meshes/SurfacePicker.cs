// SPDX-License-Identifier: MIT
using System;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Finds the first triangle of a surface that a ray meets. Triangles come in the order of the bricks they lie in,
    /// so runs of them are small in space: a box around each run is all the index there is. It is made by the first
    /// question after a new surface (a few nanoseconds per triangle). Main thread only.
    /// </summary>
    internal sealed unsafe class SurfacePicker : IDisposable
    {
        private const int RunIndices = 3 * 128;

        private readonly UnmanagedBuffer<Box> _boxes = new UnmanagedBuffer<Box>();
        private bool _isIndexed;

        /// <summary>The mesh has changed.</summary>
        public void Forget() => _isIndexed = false;

        public void Dispose() => _boxes.Dispose();

        /// <param name="mesh">Made by <see cref="SurfaceMeshUploader"/>.</param>
        /// <param name="origin">In the coordinates of the mesh.</param>
        /// <param name="direction">Of any length but 0.</param>
        /// <param name="vertex">The corner of the triangle that weighs most at the point.</param>
        /// <param name="distance">In lengths of the direction, at least 0.</param>
        public bool TryPick(Mesh mesh, Vector3 origin, Vector3 direction, out int vertex, out float distance)
        {
            using (Mesh.MeshDataArray meshes = Mesh.AcquireReadOnlyMeshData(mesh))
            {
                Mesh.MeshData data = meshes[0];
                NativeArray<byte> vertexBytes = data.GetVertexData<byte>();
                NativeArray<uint> indexData = data.GetIndexData<uint>();
                int indexCount = data.GetSubMesh(0).indexCount;
                var triangles = new Triangles
                {
                    Vertices = (byte*)vertexBytes.GetUnsafeReadOnlyPtr(),
                    Stride = data.vertexCount == 0 ? 0 : vertexBytes.Length / data.vertexCount,
                    Indices = (uint*)indexData.GetUnsafeReadOnlyPtr(),
                    Count = indexCount
                };
                if (!_isIndexed)
                    MakeIndex(triangles);
                return TryPick(triangles, origin, direction, out vertex, out distance);
            }
        }

        private void MakeIndex(in Triangles triangles)
        {
            Span<Box> boxes = _boxes.Resize((triangles.Count + RunIndices - 1) / RunIndices);
            for (int run = 0; run < boxes.Length; ++run)
            {
                int begin = run * RunIndices, end = Math.Min(begin + RunIndices, triangles.Count);
                Vector3 low = triangles.Corner(begin), high = low;
                for (int i = begin + 1; i < end; ++i)
                {
                    Vector3 corner = triangles.Corner(i);
                    low = Vector3.Min(low, corner);
                    high = Vector3.Max(high, corner);
                }
                boxes[run] = new Box { Low = low, High = high };
            }
            _isIndexed = true;
        }

        private bool TryPick(
            in Triangles triangles, Vector3 origin, Vector3 direction, out int vertex, out float distance)
        {
            vertex = -1;
            distance = float.PositiveInfinity;
            ReadOnlySpan<Box> boxes = _boxes.Span;
            for (int run = 0; run < boxes.Length; ++run)
            {
                if (!boxes[run].IsMet(origin, direction, distance))
                    continue;
                int end = Math.Min((run + 1) * RunIndices, triangles.Count);
                for (int i = run * RunIndices; i < end; i += 3)
                    if (triangles.IsMet(i, origin, direction, distance, out float t, out int corner))
                    {
                        distance = t;
                        vertex = (int)triangles.Indices[i + corner];
                    }
            }
            return vertex >= 0;
        }

        private struct Box
        {
            public Vector3 Low;
            public Vector3 High;

            // Whether the ray is within the box somewhere from 0 to `limit`. Borders count; so does a direction with
            // zeros, since NaN (0/0, on the border of a slab) loses every comparison.
            public bool IsMet(Vector3 origin, Vector3 direction, float limit)
            {
                float enter = 0, leave = limit;
                for (int axis = 0; axis < 3; ++axis)
                {
                    float inverse = 1 / direction[axis];
                    float a = (Low[axis] - origin[axis]) * inverse, b = (High[axis] - origin[axis]) * inverse;
                    float near = a < b ? a : b, far = a < b ? b : a;
                    if (near > enter)
                        enter = near;
                    if (far < leave)
                        leave = far;
                }
                return enter <= leave;
            }
        }

        private struct Triangles
        {
            public byte* Vertices;
            public int Stride;
            public uint* Indices;
            public int Count; // of indices

            public Vector3 Corner(int i) => *(Vector3*)(Vertices + (long)Stride * Indices[i]);

            // Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997; either side counts.
            public bool IsMet(
                int first, Vector3 origin, Vector3 direction, float limit, out float distance, out int corner)
            {
                Vector3 a = Corner(first), ab = Corner(first + 1) - a, ac = Corner(first + 2) - a;
                Vector3 p = Vector3.Cross(direction, ac), q = Vector3.Cross(origin - a, ab);
                float inverse = 1 / Vector3.Dot(ab, p);
                float v = Vector3.Dot(origin - a, p) * inverse, w = Vector3.Dot(direction, q) * inverse, u = 1 - v - w;
                distance = Vector3.Dot(ac, q) * inverse;
                corner = u >= v && u >= w ? 0 : v >= w ? 1 : 2;
                return u >= 0 && v >= 0 && w >= 0 && distance >= 0 && distance < limit;
            }
        }
    }
}
