// SPDX-License-Identifier: MIT
// Questions about the surface that is shown.
using System;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        [NonSerialized] private IntPtr _owners; // uint each, of what is shown
        [NonSerialized] private int _ownerCount;

        /// <summary>
        /// Å², of the whole surface that is shown, before the transform; cavities count as well, and what
        /// <see cref="SetVisible(bool[])"/> hides.
        /// </summary>
        public double Area => Shown.Area;

        /// <summary>Å³, enclosed by the whole surface, before the transform; cavities count negative.</summary>
        public double Volume => Shown.Volume;

        /// <summary>
        /// The closed pieces of the surface, cavities among them, if <see cref="MeasureComponents"/>. Valid until the
        /// next surface is shown.
        /// </summary>
        public ReadOnlySpan<SurfaceComponent> Components => Shown.View.Components;

        /// <summary>
        /// The atom of each vertex of the mesh, as an index into the atoms the shown surface is of. In native memory,
        /// nothing is copied. Valid until the next surface is shown.
        /// </summary>
        public ReadOnlySpan<uint> Owners => Shown.View.Owners;

        /// <summary>
        /// With <see cref="SharpCreases"/> the mesh has vertices on creases once per side: of its last ones, as many as there
        /// are numbers, which vertex each of them stands for, in ascending order. Taken for one the mesh is closed. Valid
        /// until the next surface is shown.
        /// </summary>
        public ReadOnlySpan<uint> Repeated => Shown.View.Repeated;

        /// <summary>
        /// The atom whose surface is nearest to a vertex of <see cref="Mesh"/>: an index into the
        /// atoms of the surface that is shown (if newer atoms are being computed: those before).
        /// </summary>
        /// <param name="vertex">From 0 to <see cref="SurfaceLevel.VertexCount"/> - 1.</param>
        public unsafe int OwnerAtomAt(int vertex)
        {
            if ((uint)vertex >= (uint)_ownerCount)
                CacheOwners(vertex);
            return (int)((uint*)_owners)[vertex];
        }

        /// <summary>
        /// The first point of the surface that a ray meets, through what <see cref="SetVisible(bool[])"/> hides. No
        /// collider is needed, and the first question after a new surface takes no longer than others: some tens of
        /// microseconds.
        /// </summary>
        /// <param name="ray">In world space, such as of Camera.ScreenPointToRay.</param>
        /// <param name="atom">The atom the point belongs to, an index as of OwnerAtomAt; -1: none.</param>
        /// <param name="point">In world space.</param>
        /// <returns>Whether the ray meets the surface.</returns>
        public bool TryPick(Ray ray, out int atom, out Vector3 point)
        {
            Matrix4x4 toLocal = transform.worldToLocalMatrix;
            bool isHit = Shown.TryPick(toLocal.MultiplyPoint3x4(ray.origin),
                toLocal.MultiplyVector(ray.direction), out SurfaceHit hit);
            atom = isHit ? hit.Owner : -1;
            point = isHit ? ray.origin + hit.Distance * ray.direction : default;
            return isHit;
        }

        /// <summary>
        /// Copies what is shown into a mesh of the caller's, with colours in the vertices however it is coloured here,
        /// without what is hidden, and with buffers of just its size: for scripts that read it, also where
        /// <see cref="Mesh"/> can't be read.
        /// </summary>
        /// <param name="mesh">Readable (its default); what it held is replaced.</param>
        public void CopyTo(Mesh mesh) => Shown.CopyTo(mesh != null ? mesh : throw new ArgumentNullException(nameof(mesh)));

        // Asked for every vertex of large surfaces, on Mono too: no question for the session or for the view but the first.
        private unsafe void CacheOwners(int vertex)
        {
            ReadOnlySpan<uint> owners = Shown.View.Owners; // throws if the component has been destroyed
            fixed (uint* first = owners)
                _owners = (IntPtr)first; // in native memory, which does not move
            _ownerCount = owners.Length;
            if ((uint)vertex >= (uint)_ownerCount)
                throw new ArgumentOutOfRangeException(nameof(vertex), vertex, $"there are {_ownerCount} vertices");
        }

        private void ForgetOwners()
        {
            _owners = IntPtr.Zero;
            _ownerCount = 0;
        }
    }
}
