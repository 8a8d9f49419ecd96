// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>Some atoms out of the frames of a trajectory.</summary>
    internal sealed class TrajectoryFrameReader : FrameReader
    {
        private readonly TrajectoryFormat _format;
        private readonly uint[] _indices;
        private readonly byte[] _elements;
        private readonly string _elementsOf;
        private readonly bool _unwrap;
        private readonly MoleculeFile _file;
        private Trajectory _trajectory;
        private float[] _xyz;
        private string _warning;

        /// <param name="file">What <paramref name="format"/> says it is; detached. Taken over.</param>
        /// <param name="format">Auto: by the name, else by the content.</param>
        /// <param name="indices">Which atoms, in which order; an atom may come more than once. Taken over.</param>
        /// <param name="elements">Atomic numbers of all that each frame has. Taken over.</param>
        /// <param name="elementsOf">What has these, for messages.</param>
        /// <param name="unwrap">Whether molecules are put together if there is a periodic box.</param>
        public TrajectoryFrameReader(MoleculeFile file, TrajectoryFormat format, uint[] indices, byte[] elements,
            string elementsOf, bool unwrap)
        {
            _file = file;
            _format = format == TrajectoryFormat.Auto ? MoleculeFile.TrajectoryFormatOf(file.Name) : format;
            _indices = indices;
            _elements = elements;
            _elementsOf = elementsOf;
            _unwrap = unwrap;
        }

        public override int FrameCount => (int)_trajectory.FrameCount;

        public override int AtomCount => _indices.Length;

        public override string Warning => _warning;

        public override bool TryOpen(out QuickSesError error)
        {
            bool isOpen = _file.Path != null
                ? Trajectory.TryOpen(_file.Path, _format, out _trajectory, out error)
                : Trajectory.TryOpen(_file.Bytes, _format, out _trajectory, out error);
            if (!isOpen)
            {
                if (_file.Path == null) // the library does not know what bytes in memory are called
                    error = new QuickSesError(error.Status, $"asset '{_file.Name}': {error.Message}");
                return false;
            }
            string name = _file.Name;
            _file.Dispose(); // its bytes are copied
            if (_trajectory.AtomCount != _elements.Length)
                return Fail($"'{name}' has {_trajectory.AtomCount} atoms per frame, but {_elementsOf} has " +
                    $"{_elements.Length}", out error);
            if (_trajectory.FrameCount > int.MaxValue)
                return Fail($"'{name}' has more than {int.MaxValue} frames", out error);
            for (int k = 0; k < _trajectory.WarningCount; ++k)
                Warn(_trajectory.GetWarning(k));
            if (_unwrap && !_trajectory.TryUnwrap(_elements, out error))
            {
                if (error.Status != QuickSesStatus.NoBox)
                    return false;
                Warn(error.Message);
                error = default;
            }
            _xyz = new float[checked(3 * _elements.Length)];
            return true;
        }

        public override bool TryRead(int frame, Span<Vector3> positions, out TrajectoryFrame info,
            out QuickSesError error)
        {
            if (!_trajectory.TryReadFrame(frame, _xyz, out info, out error))
                return false;
            UnitySpace.FromFile(_xyz, _indices, positions);
            return true;
        }

        public override void Dispose()
        {
            _trajectory?.Dispose();
            _file.Dispose();
        }

        private void Warn(string sentence) => _warning = _warning == null ? sentence : $"{_warning}\n{sentence}";

        private static bool Fail(string message, out QuickSesError error)
        {
            error = new QuickSesError(QuickSesStatus.InvalidArgument, message);
            return false;
        }
    }
}
