// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace UnityEngine.Rendering
{
    [StructLayout(LayoutKind.Sequential)]
    public struct VertexAttributeDescriptor : IEquatable<VertexAttributeDescriptor>
    {
        public VertexAttributeDescriptor(VertexAttribute attribute = VertexAttribute.Position,
            VertexAttributeFormat format = VertexAttributeFormat.Float32, int dimension = 3, int stream = 0)
        {
            this.attribute = attribute;
            this.format = format;
            this.dimension = dimension;
            this.stream = stream;
        }

        public VertexAttribute attribute { get; set; }

        public VertexAttributeFormat format { get; set; }

        public int dimension { get; set; }

        public int stream { get; set; }

        public readonly bool Equals(VertexAttributeDescriptor other) => attribute == other.attribute &&
            format == other.format && dimension == other.dimension && stream == other.stream;

        public override readonly bool Equals(object other) =>
            other is VertexAttributeDescriptor descriptor && Equals(descriptor);

        public override readonly int GetHashCode() => HashCode.Combine(attribute, format, dimension, stream);

        public override readonly string ToString() =>
            $"(attr={attribute} fmt={format} dim={dimension} stream={stream})";

        public static bool operator ==(VertexAttributeDescriptor lhs, VertexAttributeDescriptor rhs) => lhs.Equals(rhs);

        public static bool operator !=(VertexAttributeDescriptor lhs, VertexAttributeDescriptor rhs) =>
            !lhs.Equals(rhs);
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct SubMeshDescriptor
    {
        public SubMeshDescriptor(int indexStart, int indexCount, MeshTopology topology = MeshTopology.Triangles)
        {
            this = default;
            this.indexStart = indexStart;
            this.indexCount = indexCount;
            this.topology = topology;
        }

        public Bounds bounds { get; set; }

        public MeshTopology topology { get; set; }

        public int indexStart { get; set; }

        public int indexCount { get; set; }

        public int baseVertex { get; set; }

        public int firstVertex { get; set; }

        public int vertexCount { get; set; }

        public override readonly string ToString() => $"(topo={topology} indices={indexStart},{indexCount} " +
            $"vertices={firstVertex},{vertexCount} basevtx={baseVertex} bounds={bounds})";
    }
}
