// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Which atoms are near others, on one side of a plane, or of residues that are chosen in part: masks for <see
    /// cref="MolecularSurface.SetVisible(ReadOnlySpan{bool})"/>. Each method gives the number of atoms that are chosen.
    /// Makes no garbage once its memory has grown. One thread at a time; static members: any thread.
    /// </summary>
    public sealed class AtomCuts
    {
        private const int MostCellsPerPoint = 8; // 32 bytes

        private readonly PointGrid _grid = new PointGrid();
        private Vector3[] _points = Array.Empty<Vector3>();

        /// <summary>Chooses the atoms that are not further than a distance from one of some atoms, and these.</summary>
        /// <param name="positions">N, such as <see cref="MolecularSurface.Positions"/>.</param>
        /// <param name="atoms">N: true for those whose surroundings are asked for, such as a ligand.</param>
        /// <param name="distance">In the unit of the positions, Å; 0 or more, finite.</param>
        /// <param name="chosen">N; may be the same memory as <paramref name="atoms"/>.</param>
        public int Within(ReadOnlySpan<Vector3> positions, ReadOnlySpan<bool> atoms, float distance, Span<bool> chosen)
        {
            ThrowUnlessPerAtom(positions.Length, atoms.Length, nameof(atoms));
            ThrowUnlessPerAtom(positions.Length, chosen.Length, nameof(chosen));
            if (_points.Length < positions.Length)
                _points = new Vector3[positions.Length];
            int count = 0;
            for (int i = 0; i < positions.Length; ++i)
                if (atoms[i])
                    _points[count++] = positions[i];
            return Within(positions, _points.AsSpan(0, count), distance, chosen);
        }

        /// <summary>Chooses the atoms that are not further than a distance from one of some points.</summary>
        /// <param name="positions">N.</param>
        /// <param name="points">Any number; those that are not finite are passed over.</param>
        /// <param name="distance">In the unit of the positions, Å; 0 or more, finite.</param>
        /// <param name="chosen">N.</param>
        public int Within(
            ReadOnlySpan<Vector3> positions, ReadOnlySpan<Vector3> points, float distance, Span<bool> chosen)
        {
            ThrowUnlessPerAtom(positions.Length, chosen.Length, nameof(chosen));
            if (!(distance >= 0 && distance <= float.MaxValue))
                throw new ArgumentOutOfRangeException(nameof(distance), distance, "must be 0 or more, and finite");
            _grid.Fill(points, distance, MostCellsPerPoint);
            int count = 0;
            for (int i = 0; i < positions.Length; ++i)
                if (chosen[i] = _grid.IsNear(positions[i]))
                    ++count;
            return count;
        }

        /// <summary>Chooses the atoms on that side of a plane to which its normal points.</summary>
        /// <param name="positions">N.</param>
        /// <param name="plane">In the space of the positions.</param>
        /// <param name="chosen">N.</param>
        public static int InFrontOf(ReadOnlySpan<Vector3> positions, Plane plane, Span<bool> chosen) =>
            InFrontOf(positions, plane.normal, plane.distance, chosen);

        /// <summary>The same for a plane in world space and atoms in that of a transform.</summary>
        /// <param name="positions">N, local.</param>
        /// <param name="plane">In world space.</param>
        /// <param name="localToWorld">Such as <see cref="Transform.localToWorldMatrix"/> of the surface.</param>
        /// <param name="chosen">N.</param>
        public static int InFrontOf(
            ReadOnlySpan<Vector3> positions, Plane plane, Matrix4x4 localToWorld, Span<bool> chosen)
        {
            var normal = new Vector3(
                Vector3.Dot(plane.normal, localToWorld.MultiplyVector(new Vector3(1, 0, 0))),
                Vector3.Dot(plane.normal, localToWorld.MultiplyVector(new Vector3(0, 1, 0))),
                Vector3.Dot(plane.normal, localToWorld.MultiplyVector(new Vector3(0, 0, 1))));
            float distance = plane.GetDistanceToPoint(localToWorld.MultiplyPoint3x4(Vector3.zero));
            return InFrontOf(positions, normal, distance, chosen);
        }

        /// <summary>Chooses all atoms of each residue of which one is chosen.</summary>
        /// <param name="residues">N: <see cref="Structure.Residues"/>.</param>
        /// <param name="chosen">N.</param>
        public static int CompleteResidues(ReadOnlySpan<uint> residues, Span<bool> chosen)
        {
            ThrowUnlessPerAtom(residues.Length, chosen.Length, nameof(chosen));
            int count = 0;
            for (int begin = 0; begin < residues.Length;)
            {
                int end = begin;
                bool isChosen = false;
                for (; end < residues.Length && residues[end] == residues[begin]; ++end)
                    isChosen |= chosen[end];
                chosen.Slice(begin, end - begin).Fill(isChosen);
                count += isChosen ? end - begin : 0;
                begin = end;
            }
            return count;
        }

        private static int InFrontOf(
            ReadOnlySpan<Vector3> positions, Vector3 normal, float distance, Span<bool> chosen)
        {
            ThrowUnlessPerAtom(positions.Length, chosen.Length, nameof(chosen));
            int count = 0;
            for (int i = 0; i < positions.Length; ++i)
            {
                Vector3 p = positions[i];
                if (chosen[i] = normal.x * p.x + normal.y * p.y + normal.z * p.z + distance > 0)
                    ++count;
            }
            return count;
        }

        private static void ThrowUnlessPerAtom(int atoms, int length, string argument)
        {
            if (length != atoms)
                throw new ArgumentException($"has {length} elements for {atoms} atoms", argument);
        }
    }
}
