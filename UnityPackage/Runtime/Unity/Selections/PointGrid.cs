// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Points sorted into cubic cells, to be asked whether one of them is near. One thread at a time; no garbage once it
    /// has grown.
    /// </summary>
    internal sealed class PointGrid
    {
        private const float Sqrt3 = 1.7320508f;

        private Vector3[] _sorted = Array.Empty<Vector3>();
        private int[] _cellOf = Array.Empty<int>();
        private int[] _begins = Array.Empty<int>(); // of each cell in _sorted, and where the last one ends
        private int _count;
        private Vector3 _low, _high;
        private int _nx, _ny, _nz;
        private int _reach; // in cells
        private float _perLength; // cells
        private float _squared; // of the distance
        private float _distance;

        /// <summary>Takes other points. What is not finite is passed over.</summary>
        /// <param name="points">Any number.</param>
        /// <param name="distance">What counts as near; 0 or more.</param>
        /// <param name="mostCellsPerPoint">Bounds the memory.</param>
        public void Fill(ReadOnlySpan<Vector3> points, float distance, int mostCellsPerPoint)
        {
            if (_sorted.Length < points.Length)
            {
                _sorted = new Vector3[points.Length];
                _cellOf = new int[points.Length];
            }
            _distance = distance;
            _squared = distance * distance;
            Measure(points);
            if (_count > 0)
                ChooseCells(mostCellsPerPoint * (long)_count);
            Sort(points);
        }

        /// <summary>Whether a point is not further than the distance.</summary>
        public bool IsNear(Vector3 p)
        {
            bool isAround = _count > 0 && // not where p is no number
                p.x >= _low.x - _distance && p.x <= _high.x + _distance &&
                p.y >= _low.y - _distance && p.y <= _high.y + _distance &&
                p.z >= _low.z - _distance && p.z <= _high.z + _distance;
            if (!isAround)
                return false;
            int x = Place(p.x - _low.x, _nx), y = Place(p.y - _low.y, _ny), z = Place(p.z - _low.z, _nz);
            int own = (z * _ny + y) * _nx + x;
            if (IsNearOne(p, own, own + 1))
                return true;
            int firstX = Math.Max(x - _reach, 0), lastX = Math.Min(x + _reach, _nx - 1);
            for (int cz = Math.Max(z - _reach, 0); cz <= Math.Min(z + _reach, _nz - 1); ++cz)
                for (int cy = Math.Max(y - _reach, 0); cy <= Math.Min(y + _reach, _ny - 1); ++cy)
                {
                    int row = (cz * _ny + cy) * _nx; // cells of a row lie one after the other
                    if (IsNearOne(p, row + firstX, row + lastX + 1))
                        return true;
                }
            return false;
        }

        private bool IsNearOne(Vector3 p, int firstCell, int endCell)
        {
            int end = _begins[endCell];
            for (int k = _begins[firstCell]; k < end; ++k)
            {
                float x = _sorted[k].x - p.x, y = _sorted[k].y - p.y, z = _sorted[k].z - p.z;
                if (x * x + y * y + z * z <= _squared)
                    return true;
            }
            return false;
        }

        private int Place(float along, int cells) => Math.Min(Math.Max((int)(along * _perLength), 0), cells - 1);

        private void Measure(ReadOnlySpan<Vector3> points)
        {
            _count = 0;
            _low = Vector3.positiveInfinity;
            _high = Vector3.negativeInfinity;
            foreach (Vector3 p in points)
            {
                if (!IsFinite(p))
                    continue;
                ++_count;
                _low = new Vector3(Math.Min(_low.x, p.x), Math.Min(_low.y, p.y), Math.Min(_low.z, p.z));
                _high = new Vector3(Math.Max(_high.x, p.x), Math.Max(_high.y, p.y), Math.Max(_high.z, p.z));
            }
        }

        // Cells whose diagonal is the distance, or larger ones where these would be too many.
        private void ChooseCells(long mostCells)
        {
            Vector3 size = _high - _low;
            float longest = Math.Max(size.x, Math.Max(size.y, size.z));
            float edge = Math.Max(Math.Max(_distance / Sqrt3, longest / 1024), 1e-6f);
            while (CountCells(size, edge) > mostCells && edge < 2 * longest)
                edge *= 1.2f;
            CountCells(size, edge);
            _perLength = 1 / edge;
            _reach = (int)Math.Min(Math.Ceiling(_distance * (double)_perLength * 1.0001), 1024);
        }

        private long CountCells(Vector3 size, float edge)
        {
            _nx = (int)(size.x / edge) + 1;
            _ny = (int)(size.y / edge) + 1;
            _nz = (int)(size.z / edge) + 1;
            return (long)_nx * _ny * _nz;
        }

        private void Sort(ReadOnlySpan<Vector3> points)
        {
            int cells = _count > 0 ? _nx * _ny * _nz : 0;
            if (_begins.Length < cells + 1)
                _begins = new int[cells + 1 + cells / 4];
            Array.Clear(_begins, 0, cells + 1);
            for (int i = 0; i < points.Length; ++i)
            {
                Vector3 p = points[i];
                if (!IsFinite(p))
                {
                    _cellOf[i] = -1;
                    continue;
                }
                _cellOf[i] = (Place(p.z - _low.z, _nz) * _ny + Place(p.y - _low.y, _ny)) * _nx + Place(p.x - _low.x, _nx);
                ++_begins[_cellOf[i]];
            }
            int end = 0;
            for (int cell = 0; cell <= cells; ++cell)
                _begins[cell] = end += _begins[cell];
            for (int i = points.Length - 1; i >= 0; --i) // backwards: each cell's end moves to its beginning
                if (_cellOf[i] >= 0)
                    _sorted[--_begins[_cellOf[i]]] = points[i];
        }

        private static bool IsFinite(Vector3 p) => p.x - p.x == 0 && p.y - p.y == 0 && p.z - p.z == 0;
    }
}
