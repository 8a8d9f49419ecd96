// SPDX-License-Identifier: MIT
// Questions about the surface that is shown.
using System;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
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
        public ReadOnlySpan<SurfaceComponent> Components => Shown.Components;

        /// <summary>
        /// The atom of each vertex of the mesh, as an index into the atoms the shown surface is of. Valid until the next
        /// surface is shown.
        /// </summary>
        public ReadOnlySpan<uint> Owners => Shown.Owners;

        /// <summary>
        /// The atom whose surface is nearest to a vertex of <see cref="Mesh"/>: an index into the
        /// atoms of the surface that is shown (if newer atoms are being computed: those before).
        /// </summary>
        /// <param name="vertex">From 0 to <see cref="SurfaceLevel.VertexCount"/> - 1.</param>
        public int OwnerAtomAt(int vertex)
        {
            ReadOnlySpan<uint> owners = Shown.Owners;
            if ((uint)vertex >= (uint)owners.Length)
                throw new ArgumentOutOfRangeException(nameof(vertex), vertex, $"there are {owners.Length} vertices");
            return (int)owners[vertex];
        }

        /// <summary>
        /// The first point of the surface that a ray meets. No collider is needed. The first question after a new
        /// surface looks at all its triangles (some milliseconds for a million), later ones at few.
        /// </summary>
        /// <param name="ray">In world space, such as of Camera.ScreenPointToRay.</param>
        /// <param name="atom">The atom the point belongs to, an index as of OwnerAtomAt; -1: none.</param>
        /// <param name="point">In world space.</param>
        /// <returns>Whether the ray meets the surface.</returns>
        public bool TryPick(Ray ray, out int atom, out Vector3 point)
        {
            Matrix4x4 toLocal = transform.worldToLocalMatrix;
            bool isHit = Shown.TryPick(toLocal.MultiplyPoint3x4(ray.origin),
                toLocal.MultiplyVector(ray.direction), out atom, out float distance);
            point = isHit ? ray.origin + distance * ray.direction : default;
            return isHit;
        }
    }
}
