// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes
{
    /// <summary>
    /// A mesh of a component's own, and how the surface in it looks. A component has two: one that is shown, and, while
    /// surfaces too large for one frame arrive, one that is being filled. Main thread only.
    /// </summary>
    internal sealed class SurfaceMesh : IDisposable
    {
        private static readonly HashSet<Mesh> s_made = new HashSet<Mesh>();

        private Mesh _mesh;
        private AtomLook _look;

        public MeshWriter Writer { get; } = new MeshWriter();

        /// <summary>Made when it is asked for; goes with this object and is not saved with scenes.</summary>
        public Mesh Mesh
        {
            get
            {
                if (_mesh == null)
                {
                    FreeMesh();
                    _mesh = MakeMesh("Molecular Surface");
                    _mesh.MarkDynamic();
                }
                return _mesh;
            }
        }

        public bool HasMesh => _mesh != null;

        /// <summary>Whether there is a surface in it.</summary>
        public bool IsFilled { get; set; }

        public MeshStyle Style { get; set; }

        /// <summary>Of the surface's atoms; the next are of it.</summary>
        public AtomLook Look
        {
            get => _look;
            set
            {
                value?.Hold();
                _look?.Release();
                _look = value;
            }
        }

        /// <summary>Colours of atoms as the vertices are painted.</summary>
        public UnmanagedBuffer<uint> Colors { get; } = new UnmanagedBuffer<uint>();

        public uint ColorsVersion { get; set; }

        /// <summary>Of the mask that triangles were left out by.</summary>
        public uint VisibleVersion { get; set; }

        public uint TexcoordsVersion { get; set; }

        /// <summary>Whether a mesh is that of a component, be it another one.</summary>
        public static bool IsMade(Mesh mesh) => mesh != null && s_made.Contains(mesh);

        /// <summary>One that <see cref="IsMade"/> knows and scenes don't save.</summary>
        public static Mesh MakeMesh(string name)
        {
            var mesh = new Mesh { name = name, hideFlags = HideFlags.DontSave };
            s_made.Add(mesh);
            return mesh;
        }

        /// <summary>Also of one that is gone; null: nothing happens.</summary>
        public static void DestroyMesh(Mesh mesh)
        {
            if (!(mesh is null))
                s_made.Remove(mesh);
            if (mesh != null)
                Object.DestroyImmediate(mesh); // at the end of play mode no later frame would destroy it
        }

        /// <summary>Shows nothing, and holds no memory for it.</summary>
        public void Clear()
        {
            IsFilled = false;
            Look = null;
            if (_mesh == null || !_mesh.isReadable)
                return;
            Writer.Reserve(_mesh, Style, 0, 0, false);
        }

        /// <summary>The next question for the mesh makes another one.</summary>
        public void FreeMesh()
        {
            IsFilled = false;
            DestroyMesh(_mesh);
            _mesh = null;
            Writer.Forget();
        }

        public void Dispose()
        {
            FreeMesh();
            Look = null;
            Writer.Dispose();
            Colors.Dispose();
        }
    }
}
