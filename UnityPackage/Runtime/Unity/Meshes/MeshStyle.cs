// SPDX-License-Identifier: MIT
using System;
using UnityEngine.Rendering;

namespace QuickSes
{
    /// <summary>
    /// Which attributes the vertices of a surface have. Streams: 0 position and normal; 1 four bytes, the colour, or the
    /// atom, whose colour a texture has; 2 texture coordinate 1, if there is one.
    /// </summary>
    internal readonly struct MeshStyle : IEquatable<MeshStyle>
    {
        public const int SurfaceStream = 0, AtomStream = 1, TexcoordStream = 2;
        public const int AtomBytes = 4, TexcoordBytes = 8;

        private static readonly VertexAttributeDescriptor[][] s_layouts = MakeLayouts();

        public MeshStyle(bool isCompact, bool hasAtoms, bool hasTexcoords)
        {
            IsCompact = isCompact;
            HasAtoms = hasAtoms;
            HasTexcoords = hasTexcoords;
        }

        /// <summary>Normals of four signed bytes instead of three floats.</summary>
        public bool IsCompact { get; }

        /// <summary>Atoms instead of colours.</summary>
        public bool HasAtoms { get; }

        public bool HasTexcoords { get; }

        /// <summary>Of a vertex in stream 0.</summary>
        public int SurfaceBytes => IsCompact ? 16 : 24;

        /// <summary>Of a vertex in all streams.</summary>
        public int VertexBytes => SurfaceBytes + AtomBytes + (HasTexcoords ? TexcoordBytes : 0);

        /// <summary>As the engine takes it. The same array for the same style.</summary>
        public VertexAttributeDescriptor[] Layout =>
            s_layouts[(IsCompact ? 1 : 0) + (HasAtoms ? 2 : 0) + (HasTexcoords ? 4 : 0)];

        public bool Equals(MeshStyle other) => Layout == other.Layout;

        public override bool Equals(object other) => other is MeshStyle style && Equals(style);

        public override int GetHashCode() => VertexBytes + (HasAtoms ? 1 : 0);

        private static VertexAttributeDescriptor[][] MakeLayouts()
        {
            var layouts = new VertexAttributeDescriptor[8][];
            for (int k = 0; k < layouts.Length; ++k)
            {
                bool isCompact = (k & 1) != 0, hasAtoms = (k & 2) != 0, hasTexcoords = (k & 4) != 0;
                layouts[k] = new VertexAttributeDescriptor[hasTexcoords ? 4 : 3];
                layouts[k][0] = new VertexAttributeDescriptor(VertexAttribute.Position, VertexAttributeFormat.Float32, 3,
                    SurfaceStream);
                layouts[k][1] = isCompact
                    ? new VertexAttributeDescriptor(VertexAttribute.Normal, VertexAttributeFormat.SNorm8, 4, SurfaceStream)
                    : new VertexAttributeDescriptor(VertexAttribute.Normal, VertexAttributeFormat.Float32, 3, SurfaceStream);
                layouts[k][2] = hasAtoms
                    ? new VertexAttributeDescriptor(VertexAttribute.TexCoord7, VertexAttributeFormat.UInt32, 1, AtomStream)
                    : new VertexAttributeDescriptor(VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4, AtomStream);
                if (hasTexcoords)
                    layouts[k][3] = new VertexAttributeDescriptor(VertexAttribute.TexCoord1,
                        VertexAttributeFormat.Float32, 2, TexcoordStream);
            }
            return layouts;
        }
    }
}
