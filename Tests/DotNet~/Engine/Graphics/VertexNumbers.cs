// SPDX-License-Identifier: MIT
using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.EngineDouble
{
    /// <summary>Numbers of vertices in the formats that vertex buffers have.</summary>
    internal static unsafe class VertexNumbers
    {
        /// <summary>Copies one attribute of all vertices; components that the mesh lacks become 0.</summary>
        public static void Read(MeshBuffers mesh, VertexAttribute attribute, VertexAttributeFormat format,
            int dimension, byte* output)
        {
            mesh.Layout.TryFind(attribute, out VertexAttributeDescriptor source, out int offset);
            int stride = mesh.Layout.StrideOf(source.stream), size = VertexLayout.SizeOf(format);
            byte* vertex = mesh.Stream(source.stream) + offset;
            for (int v = 0; v < mesh.VertexCount; ++v, vertex += stride)
                for (int i = 0; i < dimension; ++i, output += size)
                    Encode(i < source.dimension ? Decode(vertex, source.format, i) : 0, format, output);
        }

        public static void Write(MeshBuffers mesh, VertexAttribute attribute, VertexAttributeFormat format,
            int dimension, byte* input)
        {
            mesh.Layout.TryFind(attribute, out VertexAttributeDescriptor target, out int offset);
            int stride = mesh.Layout.StrideOf(target.stream), size = VertexLayout.SizeOf(target.format);
            byte* vertex = mesh.Stream(target.stream) + offset;
            int inputStride = VertexLayout.SizeOf(format) * dimension;
            for (int v = 0; v < mesh.VertexCount; ++v, vertex += stride, input += inputStride)
                for (int i = 0; i < target.dimension; ++i)
                    Encode(i < dimension ? Decode(input, format, i) : 0, target.format, vertex + i * size);
        }

        public static Vector3 ReadPosition(MeshBuffers mesh, VertexAttributeDescriptor position, int offset,
            long vertex)
        {
            byte* at = mesh.Stream(position.stream) + vertex * mesh.Layout.StrideOf(position.stream) + offset;
            return new Vector3((float)Decode(at, position.format, 0),
                position.dimension > 1 ? (float)Decode(at, position.format, 1) : 0,
                position.dimension > 2 ? (float)Decode(at, position.format, 2) : 0);
        }

        private static double Decode(byte* numbers, VertexAttributeFormat format, int index) => format switch
        {
            VertexAttributeFormat.Float32 => ((float*)numbers)[index],
            VertexAttributeFormat.UNorm8 => numbers[index] / 255.0,
            VertexAttributeFormat.SNorm8 => Math.Max(-1, ((sbyte*)numbers)[index] / 127.0),
            VertexAttributeFormat.UInt32 => ((uint*)numbers)[index],
            _ => throw new NotSupportedException($"The double does not read numbers of format {format}.")
        };

        private static void Encode(double number, VertexAttributeFormat format, byte* output)
        {
            if (format == VertexAttributeFormat.Float32)
                *(float*)output = (float)number;
            else if (format == VertexAttributeFormat.UNorm8)
                *output = (byte)Math.Round(Math.Max(0, Math.Min(1, number)) * 255);
            else if (format == VertexAttributeFormat.SNorm8)
                *(sbyte*)output = (sbyte)Math.Round(Math.Max(-1, Math.Min(1, number)) * 127);
            else if (format == VertexAttributeFormat.UInt32)
                *(uint*)output = (uint)number;
            else
                throw new NotSupportedException($"The double does not write numbers of format {format}.");
        }
    }
}
