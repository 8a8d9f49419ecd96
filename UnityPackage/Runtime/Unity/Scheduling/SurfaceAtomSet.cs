// SPDX-License-Identifier: MIT
using System;
using System.Numerics;
using System.Runtime.InteropServices;

namespace QuickSes
{
    /// <summary>
    /// The atoms of one surface. Contexts are shared and forget, so this is the copy that is sent again. Versions rise
    /// with every change, so that only what a context lacks is sent. Colours are four bytes: red, green, blue, alpha.
    /// Main thread only; no garbage once it has grown.
    /// </summary>
    internal sealed class SurfaceAtomSet : IDisposable
    {
        private readonly UnmanagedBuffer<Vector3> _positions = new UnmanagedBuffer<Vector3>();
        private readonly UnmanagedBuffer<float> _radii = new UnmanagedBuffer<float>();
        private readonly UnmanagedBuffer<uint> _colors = new UnmanagedBuffer<uint>();
        private readonly UnmanagedBuffer<byte> _visible = new UnmanagedBuffer<byte>();
        private readonly UnmanagedBuffer<Vector2> _texcoords = new UnmanagedBuffer<Vector2>();
        private readonly UnmanagedBuffer<bool> _hasBaseColor = new UnmanagedBuffer<bool>(); // per atom
        private uint _baseColor = uint.MaxValue; // white
        private uint _atomsVersion; // radii, and with them the number of atoms
        private uint _positionsVersion;
        private uint _appearanceVersion;

        /// <summary>Whether <see cref="SetAtoms"/> was called, be it with no atoms at all.</summary>
        public bool IsSet { get; private set; }

        public int Count => _radii.Length;

        public ReadOnlySpan<Vector3> Positions => _positions.Span;

        public bool HasTexcoords => _texcoords.Length > 0;

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
            bool keepsAppearance = IsSet && radii.Length == Count;
            _radii.CopyFrom(radii);
            ++_atomsVersion;
            IsSet = true;
            if (!keepsAppearance)
                ResetAppearance();
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
            for (int i = 0; i < indices.Length; ++i)
                picked[i] = frame[indices[i]];
            ++_positionsVersion;
        }

        /// <summary>Empty: all atoms in the base colour.</summary>
        public void SetColors(ReadOnlySpan<uint> colors)
        {
            if (!colors.IsEmpty)
                ThrowUnlessPerAtom(colors.Length, nameof(colors));
            _hasBaseColor.Resize(Count).Fill(colors.IsEmpty);
            if (colors.IsEmpty)
                _colors.Resize(Count).Fill(_baseColor);
            else
                _colors.CopyFrom(colors);
            ++_appearanceVersion;
        }

        /// <summary>Transparent black stands for the base colour.</summary>
        public void SetSchemeColors(ReadOnlySpan<uint> colors)
        {
            ThrowUnlessPerAtom(colors.Length, nameof(colors));
            _colors.CopyFrom(colors);
            Span<bool> hasBaseColor = _hasBaseColor.Resize(Count);
            for (int i = 0; i < hasBaseColor.Length; ++i)
                hasBaseColor[i] = colors[i] == 0;
            FillBaseColor();
            ++_appearanceVersion;
        }

        /// <returns>Whether anything shown changes.</returns>
        public bool SetBaseColor(uint color)
        {
            if (color == _baseColor)
                return false;
            _baseColor = color;
            if (!FillBaseColor())
                return false;
            ++_appearanceVersion;
            return true;
        }

        /// <summary>Empty: all.</summary>
        public void SetVisible(ReadOnlySpan<bool> visible)
        {
            if (!visible.IsEmpty)
                ThrowUnlessPerAtom(visible.Length, nameof(visible));
            Span<byte> mask = _visible.Resize(visible.Length);
            for (int i = 0; i < mask.Length; ++i)
                mask[i] = visible[i] ? (byte)1 : (byte)0;
            ++_appearanceVersion;
        }

        /// <summary>Empty: none.</summary>
        public void SetTexcoords(ReadOnlySpan<Vector2> texcoords)
        {
            if (!texcoords.IsEmpty)
                ThrowUnlessPerAtom(texcoords.Length, nameof(texcoords));
            _texcoords.CopyFrom(texcoords);
            ++_appearanceVersion;
        }

        public void Clear()
        {
            IsSet = false;
            _positions.Resize(0);
            _radii.Resize(0);
            ResetAppearance();
            ++_atomsVersion;
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
            if (status == QuickSesStatus.Ok && (isFresh || slot.SentAppearance != _appearanceVersion))
                status = SendAppearance(context);
            if (status != QuickSesStatus.Ok)
                return status;
            slot.SentBy = this;
            slot.SentAtoms = _atomsVersion;
            slot.SentPositions = _positionsVersion;
            slot.SentAppearance = _appearanceVersion;
            return status;
        }

        public void Dispose()
        {
            _positions.Dispose();
            _radii.Dispose();
            _colors.Dispose();
            _hasBaseColor.Dispose();
            _visible.Dispose();
            _texcoords.Dispose();
        }

        // Whether there is an atom that has it.
        private bool FillBaseColor()
        {
            Span<uint> colors = _colors.Span;
            Span<bool> hasBaseColor = _hasBaseColor.Span;
            bool isAny = false;
            for (int i = 0; i < colors.Length; ++i)
                if (hasBaseColor[i])
                {
                    colors[i] = _baseColor;
                    isAny = true;
                }
            return isAny;
        }

        private QuickSesStatus SendAppearance(SurfaceContext context)
        {
            QuickSesStatus status = context.SetColors(MemoryMarshal.AsBytes(_colors.Span));
            if (status == QuickSesStatus.Ok)
                status = context.SetVisible(_visible.Span);
            if (status == QuickSesStatus.Ok)
                status = context.SetTexcoords(MemoryMarshal.Cast<Vector2, float>(_texcoords.Span));
            return status;
        }

        private static ReadOnlySpan<float> Floats(ReadOnlySpan<Vector3> vectors) =>
            MemoryMarshal.Cast<Vector3, float>(vectors);

        // Appearance belongs to atoms: it goes with them.
        private void ResetAppearance()
        {
            _visible.Resize(0);
            _texcoords.Resize(0);
            SetColors(default);
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
