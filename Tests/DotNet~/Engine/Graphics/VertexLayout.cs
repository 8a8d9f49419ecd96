// SPDX-License-Identifier: MIT
using System;
using UnityEngine.Rendering;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// Where the attributes of a vertex lie: in each stream one after the other, in the order of VertexAttribute,
    /// whatever order they were given in.
    /// </summary>
    internal sealed class VertexLayout
    {
        public const int StreamCount = 4;
        private const int AttributeKinds = (int)VertexAttribute.BlendIndices + 1;

        private readonly VertexAttributeDescriptor[] _attributes = new VertexAttributeDescriptor[AttributeKinds];
        private readonly int[] _offsets = new int[AttributeKinds];
        private readonly int[] _strides = new int[StreamCount];

        public int Count { get; private set; }

        /// <summary>Streams up to the last that has an attribute.</summary>
        public int UsedStreams
        {
            get
            {
                int used = StreamCount;
                while (used > 0 && _strides[used - 1] == 0)
                    --used;
                return used;
            }
        }

        public int StrideOf(int stream) => (uint)stream < StreamCount ? _strides[stream] : 0;

        public void Set(ReadOnlySpan<VertexAttributeDescriptor> attributes)
        {
            Check(attributes);
            Count = 0;
            for (VertexAttribute attribute = 0; (int)attribute < AttributeKinds; ++attribute)
                for (int i = 0; i < attributes.Length; ++i)
                    if (attributes[i].attribute == attribute)
                        _attributes[Count++] = attributes[i];
            Array.Clear(_strides, 0, StreamCount);
            for (int i = 0; i < Count; ++i)
            {
                _offsets[i] = _strides[_attributes[i].stream];
                _strides[_attributes[i].stream] += SizeOf(_attributes[i].format) * _attributes[i].dimension;
            }
        }

        public ReadOnlySpan<VertexAttributeDescriptor> Attributes => _attributes.AsSpan(0, Count);

        public bool TryFind(VertexAttribute attribute, out VertexAttributeDescriptor descriptor, out int offset)
        {
            for (int i = 0; i < Count; ++i)
            {
                if (_attributes[i].attribute != attribute)
                    continue;
                descriptor = _attributes[i];
                offset = _offsets[i];
                return true;
            }

            descriptor = default;
            offset = -1;
            return false;
        }

        public static int SizeOf(VertexAttributeFormat format) => format switch
        {
            VertexAttributeFormat.Float32 => 4,
            VertexAttributeFormat.UInt32 => 4,
            VertexAttributeFormat.SInt32 => 4,
            VertexAttributeFormat.Float16 => 2,
            VertexAttributeFormat.UNorm16 => 2,
            VertexAttributeFormat.SNorm16 => 2,
            VertexAttributeFormat.UInt16 => 2,
            VertexAttributeFormat.SInt16 => 2,
            _ => 1
        };

        // All of it before anything is changed.
        private static void Check(ReadOnlySpan<VertexAttributeDescriptor> attributes)
        {
            for (int i = 0; i < attributes.Length; ++i)
            {
                VertexAttributeDescriptor attribute = attributes[i];
                if (attribute.dimension < 1 || attribute.dimension > 4)
                    throw new ArgumentException($"{attribute} has an invalid dimension; it must be from 1 to 4.");
                if (attribute.stream < 0 || attribute.stream >= StreamCount)
                    throw new ArgumentException($"{attribute} has an invalid stream; it must be from 0 to 3.");
                if (SizeOf(attribute.format) * attribute.dimension % 4 != 0)
                    throw new ArgumentException($"{attribute} has a size that is not a multiple of 4 bytes.");
                for (int j = 0; j < i; ++j)
                    if (attributes[j].attribute == attribute.attribute)
                        throw new ArgumentException($"Vertex attribute {attribute.attribute} is there twice.");
            }
        }
    }
}
