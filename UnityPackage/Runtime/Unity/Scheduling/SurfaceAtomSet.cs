// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// The atoms of one surface. Contexts are shared and forget, so this is the copy that is sent again. Versions rise
    /// with every change, so that only what a context lacks is sent. Main thread only; no garbage once it has grown.
    /// </summary>
    internal sealed class SurfaceAtomSet : IDisposable
    {
        private readonly UnmanagedBuffer<Vector3> _positions = new UnmanagedBuffer<Vector3>();
        private readonly UnmanagedBuffer<float> _radii = new UnmanagedBuffer<float>();
        private readonly UnmanagedBuffer<Color32> _colors = new UnmanagedBuffer<Color32>();
        private readonly UnmanagedBuffer<byte> _visible = new UnmanagedBuffer<byte>();
        private readonly UnmanagedBuffer<Vector2> _texcoords = new UnmanagedBuffer<Vector2>();
        private readonly UnmanagedBuffer<bool> _hasBaseColor = new UnmanagedBuffer<bool>(); // per atom
        private Color32 _baseColor = new Color32(255, 255, 255, 255);
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
        public void SetColors(ReadOnlySpan<Color32> colors)
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
        public void SetSchemeColors(ReadOnlySpan<Color32> colors)
        {
            ThrowUnlessPerAtom(colors.Length, nameof(colors));
            _colors.CopyFrom(colors);
            Span<bool> hasBaseColor = _hasBaseColor.Resize(Count);
            for (int i = 0; i < hasBaseColor.Length; ++i)
                hasBaseColor[i] = AreSame(colors[i], default);
            FillBaseColor();
            ++_appearanceVersion;
        }

        /// <returns>Whether anything shown changes.</returns>
        public bool SetBaseColor(Color32 color)
        {
            if (AreSame(color, _baseColor))
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
                status = context.SetAtoms(SurfaceArrays.Floats(_positions.Span), _radii.Span);
            else if (slot.SentPositions != _positionsVersion)
                status = context.SetPositions(SurfaceArrays.Floats(_positions.Span));
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
            Span<Color32> colors = _colors.Span;
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

        private static bool AreSame(Color32 a, Color32 b) => a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a;

        private QuickSesStatus SendAppearance(SurfaceContext context)
        {
            QuickSesStatus status = context.SetColors(MemoryMarshal.AsBytes((ReadOnlySpan<Color32>)_colors.Span));
            if (status == QuickSesStatus.Ok)
                status = context.SetVisible(_visible.Span);
            if (status == QuickSesStatus.Ok)
                status = context.SetTexcoords(MemoryMarshal.Cast<Vector2, float>(_texcoords.Span));
            return status;
        }

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
