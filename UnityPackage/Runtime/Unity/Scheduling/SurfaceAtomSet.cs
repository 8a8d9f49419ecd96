// SPDX-License-Identifier: MIT
using System;
using System.Numerics;
using System.Runtime.InteropServices;

namespace QuickSes
{
    /// <summary>
    /// The atoms of one surface. Contexts are shared and forget, so this is the copy that is sent again. Versions rise
    /// with every change, so that only what a context lacks is sent. How atoms look is beside them: contexts need not
    /// know. Main thread only; no garbage once it has grown.
    /// </summary>
    internal sealed class SurfaceAtomSet : IDisposable
    {
        private readonly UnmanagedBuffer<Vector3> _positions = new UnmanagedBuffer<Vector3>();
        private readonly UnmanagedBuffer<float> _radii = new UnmanagedBuffer<float>();
        private uint _baseColor = uint.MaxValue; // white
        private uint _atomsVersion; // radii, and with them the number of atoms
        private uint _positionsVersion;

        /// <summary>Whether <see cref="SetAtoms"/> was called, be it with no atoms at all.</summary>
        public bool IsSet { get; private set; }

        public int Count => _radii.Length;

        public ReadOnlySpan<Vector3> Positions => _positions.Span;

        /// <summary>Another one with another number of atoms: it goes with them.</summary>
        public AtomLook Look { get; private set; } = new AtomLook(0, uint.MaxValue);

        /// <returns>Whether only positions are new.</returns>
        public bool SetAtoms(ReadOnlySpan<Vector3> positions, ReadOnlySpan<float> radii)
        {
            if (positions.Length != radii.Length)
                throw new ArgumentException($"there are {positions.Length} positions but {radii.Length} radii",
                    nameof(radii));
            bool isSameMolecule = IsSet && radii.SequenceEqual(_radii.Span);
            _positions.CopyFrom(positions);
            ++_positionsVersion;
            if (isSameMolecule)
                return true;
            bool keepsLook = IsSet && radii.Length == Count;
            _radii.CopyFrom(radii);
            ++_atomsVersion;
            IsSet = true;
            if (!keepsLook)
                ResetLook();
            return false;
        }

        public void SetPositions(ReadOnlySpan<Vector3> positions)
        {
            ThrowUnlessPerAtom(positions.Length, nameof(positions));
            _positions.CopyFrom(positions);
            ++_positionsVersion;
        }

        public void SetPositions(ReadOnlySpan<Vector3> frame, ReadOnlySpan<int> indices)
        {
            ThrowUnlessPerAtom(indices.Length, nameof(indices));
            for (int i = 0; i < indices.Length; ++i)
                if ((uint)indices[i] >= (uint)frame.Length)
                    throw new ArgumentOutOfRangeException(nameof(indices), indices[i],
                        $"index {i} points out of the {frame.Length} positions");
            Span<Vector3> picked = _positions.Span;
            if (frame.Overlaps(picked)) // Positions themselves
                frame = frame.ToArray();
            for (int i = 0; i < indices.Length; ++i)
                picked[i] = frame[indices[i]];
            ++_positionsVersion;
        }

        /// <summary>Empty: all atoms in the base colour.</summary>
        public void SetColors(ReadOnlySpan<uint> colors)
        {
            if (!colors.IsEmpty)
                ThrowUnlessPerAtom(colors.Length, nameof(colors));
            Look.SetColors(colors, _baseColor);
        }

        /// <summary>Transparent black stands for the base colour.</summary>
        public void SetSchemeColors(ReadOnlySpan<uint> colors)
        {
            ThrowUnlessPerAtom(colors.Length, nameof(colors));
            Look.SetSchemeColors(colors, _baseColor);
        }

        public void SetBaseColor(uint color)
        {
            if (color == _baseColor)
                return;
            _baseColor = color;
            Look.SetBaseColor(color);
        }

        /// <summary>Empty: all.</summary>
        public void SetVisible(ReadOnlySpan<bool> visible)
        {
            if (!visible.IsEmpty)
                ThrowUnlessPerAtom(visible.Length, nameof(visible));
            Look.SetVisible(visible);
        }

        /// <summary>Empty: none.</summary>
        public void SetTexcoords(ReadOnlySpan<Vector2> texcoords)
        {
            if (!texcoords.IsEmpty)
                ThrowUnlessPerAtom(texcoords.Length, nameof(texcoords));
            Look.SetTexcoords(texcoords);
        }

        public void Clear()
        {
            IsSet = false;
            _positions.Resize(0);
            _radii.Resize(0);
            ResetLook();
        }

        /// <summary>Brings a context up to date. Throws <see cref="QuickSesException"/> if an atom is wrong.</summary>
        public QuickSesStatus Send(ContextSlot slot)
        {
            SurfaceContext context = slot.Context;
            bool isFresh = slot.SentBy != this || slot.SentAtoms != _atomsVersion;
            slot.SentBy = null; // should something fail half way
            var status = QuickSesStatus.Ok;
            if (isFresh)
                status = context.SetAtoms(Floats(_positions.Span), _radii.Span);
            else if (slot.SentPositions != _positionsVersion)
                status = context.SetPositions(Floats(_positions.Span));
            if (status != QuickSesStatus.Ok)
                return status;
            slot.SentBy = this;
            slot.SentAtoms = _atomsVersion;
            slot.SentPositions = _positionsVersion;
            return status;
        }

        public void Dispose()
        {
            _positions.Dispose();
            _radii.Dispose();
            Look.Release();
        }

        private static ReadOnlySpan<float> Floats(ReadOnlySpan<Vector3> vectors) =>
            MemoryMarshal.Cast<Vector3, float>(vectors);

        private void ResetLook()
        {
            Look.Release();
            Look = new AtomLook(Count, _baseColor);
        }

        private void ThrowUnlessPerAtom(int length, string argument)
        {
            if (!IsSet)
                throw new InvalidOperationException("There are no atoms yet: call SetAtoms first.");
            if (length != Count)
                throw new ArgumentException($"has {length} elements for {Count} atoms", argument);
        }
    }
}
