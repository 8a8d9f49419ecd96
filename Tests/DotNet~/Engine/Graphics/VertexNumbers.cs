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
            VertexAttributeFormat.Float16 => HalfToDouble(((ushort*)numbers)[index]),
            VertexAttributeFormat.UNorm8 => numbers[index] / 255.0,
            VertexAttributeFormat.SNorm8 => Math.Max(((sbyte*)numbers)[index] / 127.0, -1),
            VertexAttributeFormat.UNorm16 => ((ushort*)numbers)[index] / 65535.0,
            VertexAttributeFormat.SNorm16 => Math.Max(((short*)numbers)[index] / 32767.0, -1),
            VertexAttributeFormat.UInt8 => numbers[index],
            VertexAttributeFormat.SInt8 => ((sbyte*)numbers)[index],
            VertexAttributeFormat.UInt16 => ((ushort*)numbers)[index],
            VertexAttributeFormat.SInt16 => ((short*)numbers)[index],
            VertexAttributeFormat.UInt32 => ((uint*)numbers)[index],
            VertexAttributeFormat.SInt32 => ((int*)numbers)[index],
            _ => throw new ArgumentOutOfRangeException(nameof(format))
        };

        private static void Encode(double number, VertexAttributeFormat format, byte* output)
        {
            switch (format)
            {
                case VertexAttributeFormat.Float32: *(float*)output = (float)number; break;
                case VertexAttributeFormat.UNorm8: *output = (byte)Scale(number, 0, 255); break;
                case VertexAttributeFormat.SNorm8: *(sbyte*)output = (sbyte)Scale(number, -1, 127); break;
                case VertexAttributeFormat.UNorm16: *(ushort*)output = (ushort)Scale(number, 0, 65535); break;
                case VertexAttributeFormat.SNorm16: *(short*)output = (short)Scale(number, -1, 32767); break;
                case VertexAttributeFormat.UInt8: *output = (byte)number; break;
                case VertexAttributeFormat.SInt8: *(sbyte*)output = (sbyte)number; break;
                case VertexAttributeFormat.UInt16: *(ushort*)output = (ushort)number; break;
                case VertexAttributeFormat.SInt16: *(short*)output = (short)number; break;
                case VertexAttributeFormat.UInt32: *(uint*)output = (uint)number; break;
                case VertexAttributeFormat.SInt32: *(int*)output = (int)number; break;
                default: throw new NotSupportedException($"The double does not write numbers of format {format}.");
            }
        }

        private static double Scale(double value, double min, double one) =>
            Math.Round(Math.Max(min, Math.Min(1, value)) * one);

        private static double HalfToDouble(ushort bits)
        {
            int exponent = bits >> 10 & 31, fraction = bits & 1023;
            double size = exponent == 0 ? Math.Pow(2, -14) * fraction / 1024
                : exponent < 31 ? Math.Pow(2, exponent - 15) * (1 + fraction / 1024.0)
                : fraction == 0 ? double.PositiveInfinity : double.NaN;
            return bits >> 15 == 0 ? size : -size;
        }
    }
}
