// SPDX-License-Identifier: MIT
using System.Runtime.InteropServices;

namespace UnityEngine.Rendering
{
    [StructLayout(LayoutKind.Sequential)]
    public struct VertexAttributeDescriptor
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

        public override readonly string ToString() =>
            $"(attr={attribute} fmt={format} dim={dimension} stream={stream})";
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
