// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Diagnostics;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes
{
    /// <summary>
    /// The surface a component shows: its mesh, and copies of what the mesh does not hold, since the context that
    /// computed it goes to others. Main thread only.
    /// </summary>
    internal sealed class ShownSurface : IDisposable
    {
        private static readonly HashSet<Mesh> s_made = new HashSet<Mesh>();

        private readonly SurfaceMeshUploader _uploader = new SurfaceMeshUploader();
        private readonly UnmanagedBuffer<uint> _owners = new UnmanagedBuffer<uint>();
        private readonly UnmanagedBuffer<SurfaceComponent> _components = new UnmanagedBuffer<SurfaceComponent>();
        private readonly SurfacePicker _picker = new SurfacePicker();
        private Mesh _mesh;
        private bool _isNewMesh;

        /// <summary>Made when it is asked for; goes with this object and is not saved with scenes.</summary>
        public Mesh Mesh
        {
            get
            {
                if (_mesh == null)
                {
                    _mesh = new Mesh { name = "Molecular Surface", hideFlags = HideFlags.DontSave };
                    _mesh.MarkDynamic();
                    s_made.Add(_mesh);
                    _isNewMesh = true;
                }
                return _mesh;
            }
        }

        /// <summary>Whether a mesh is that of a component, be it another one.</summary>
        public static bool IsMade(Mesh mesh) => mesh != null && s_made.Contains(mesh);

        /// <summary>Whether the mesh was made since the last question: whoever shows it has to be told.</summary>
        public bool TakeIsNewMesh()
        {
            bool isNew = _isNewMesh;
            _isNewMesh = false;
            return isNew;
        }

        public double Area { get; private set; }

        public double Volume { get; private set; }

        public ReadOnlySpan<SurfaceComponent> Components => _components.Span;

        /// <summary>The atom of each vertex.</summary>
        public ReadOnlySpan<uint> Owners => _owners.Span;

        /// <summary>Shows another surface.</summary>
        public SurfaceLevel Show(in SurfaceMeshView view, in SurfaceReport report, ReadOnlySpan<float> ladder,
            bool isOfNewestAtoms, bool padBuffers)
        {
            long begin = Stopwatch.GetTimestamp();
            _uploader.Upload(view, Mesh, padBuffers);
            _owners.CopyFrom(view.Owners);
            _components.CopyFrom(view.Components);
            _picker.Forget();
            double milliseconds = (Stopwatch.GetTimestamp() - begin) * 1000.0 / Stopwatch.Frequency;
            Area = report.Area;
            Volume = report.Volume;
            return new SurfaceLevel(view, report, ladder, isOfNewestAtoms, milliseconds);
        }

        /// <summary>Shows nothing.</summary>
        public void Clear()
        {
            if (_mesh != null)
                _uploader.Upload(default, _mesh);
            _owners.Resize(0);
            _components.Resize(0);
            _picker.Forget();
            Area = Volume = 0;
        }

        /// <summary>The first triangle that a ray meets; false: none.</summary>
        /// <param name="origin">In the coordinates of the mesh.</param>
        /// <param name="direction">The same; of any length but 0.</param>
        /// <param name="atom">Of the corner that is nearest to the point.</param>
        /// <param name="distance">In lengths of the direction.</param>
        public bool TryPick(Vector3 origin, Vector3 direction, out int atom, out float distance)
        {
            atom = -1;
            distance = 0;
            if (_mesh == null || _owners.Length == 0 ||
                !_picker.TryPick(_mesh, origin, direction, out int vertex, out distance))
                return false;
            atom = (int)_owners.Span[vertex];
            return true;
        }

        public void Dispose()
        {
            if (!(_mesh is null))
                s_made.Remove(_mesh);
            if (_mesh != null)
                Object.DestroyImmediate(_mesh); // at the end of play mode no later frame would destroy it
            _mesh = null;
            _uploader.Dispose();
            _owners.Dispose();
            _components.Dispose();
            _picker.Dispose();
        }
    }
}
