// SPDX-License-Identifier: MIT
using System;
using System.Numerics;

namespace QuickSes
{
    /// <summary>
    /// How the atoms of one molecule look: colours (four bytes: red, green, blue, alpha), which are hidden, texture
    /// coordinates. It lives for as long as somebody holds it, so that surfaces of a molecule that has been replaced
    /// still have theirs. Numbers of versions rise with every change. Main thread only; no garbage once it has grown.
    /// </summary>
    internal sealed class AtomLook
    {
        private readonly UnmanagedBuffer<uint> _colors = new UnmanagedBuffer<uint>();
        private readonly UnmanagedBuffer<bool> _hasBaseColor = new UnmanagedBuffer<bool>(); // per atom
        private readonly UnmanagedBuffer<byte> _visible = new UnmanagedBuffer<byte>();
        private readonly UnmanagedBuffer<Vector2> _texcoords = new UnmanagedBuffer<Vector2>();
        private int _holders = 1;

        /// <summary>All atoms are shown in one colour. The caller holds it.</summary>
        public AtomLook(int count, uint baseColor)
        {
            Count = count;
            _hasBaseColor.Resize(count).Fill(true);
            _colors.Resize(count).Fill(baseColor);
        }

        public int Count { get; }

        public ReadOnlySpan<uint> Colors => _colors.Span;

        public uint ColorsVersion { get; private set; }

        /// <summary>1 or 0 per atom; empty: all are shown.</summary>
        public ReadOnlySpan<byte> Visible => _visible.Span;

        public uint VisibleVersion { get; private set; }

        /// <summary>Empty: none.</summary>
        public ReadOnlySpan<Vector2> Texcoords => _texcoords.Span;

        public uint TexcoordsVersion { get; private set; }

        public AtomLook Hold()
        {
            ++_holders;
            return this;
        }

        /// <summary>Who held it does no longer.</summary>
        public void Release()
        {
            if (--_holders > 0)
                return;
            _colors.Dispose();
            _hasBaseColor.Dispose();
            _visible.Dispose();
            _texcoords.Dispose();
        }

        /// <param name="colors">Per atom; empty: all in the base colour.</param>
        /// <param name="baseColor">As it is now.</param>
        public void SetColors(ReadOnlySpan<uint> colors, uint baseColor)
        {
            _hasBaseColor.Span.Fill(colors.IsEmpty);
            if (colors.IsEmpty)
            {
                SetBaseColor(baseColor);
            }
            else if (!colors.SequenceEqual(_colors.Span))
            {
                colors.CopyTo(_colors.Span);
                ++ColorsVersion;
            }
        }

        /// <summary>The same; transparent black stands for the base colour.</summary>
        public void SetSchemeColors(ReadOnlySpan<uint> colors, uint baseColor)
        {
            SetColors(colors, baseColor);
            Span<bool> hasBaseColor = _hasBaseColor.Span;
            for (int i = 0; i < hasBaseColor.Length; ++i)
                hasBaseColor[i] = colors[i] == 0;
            SetBaseColor(baseColor);
        }

        public void SetBaseColor(uint color)
        {
            Span<uint> colors = _colors.Span;
            Span<bool> hasBaseColor = _hasBaseColor.Span;
            bool isAny = false;
            for (int i = 0; i < colors.Length; ++i)
                if (hasBaseColor[i] && colors[i] != color)
                {
                    colors[i] = color;
                    isAny = true;
                }
            if (isAny)
                ++ColorsVersion;
        }

        /// <param name="visible">Per atom; empty: all.</param>
        public void SetVisible(ReadOnlySpan<bool> visible)
        {
            int hidden = 0, changed = 0;
            Span<byte> mask = _visible.Span;
            for (int i = 0; i < visible.Length; ++i)
            {
                hidden += visible[i] ? 0 : 1;
                changed += visible[i] == (mask.IsEmpty || mask[i] != 0) ? 0 : 1;
            }
            if (hidden == 0 ? mask.IsEmpty : changed == 0)
                return;
            mask = _visible.Resize(hidden == 0 ? 0 : visible.Length);
            for (int i = 0; i < mask.Length; ++i)
                mask[i] = visible[i] ? (byte)1 : (byte)0;
            ++VisibleVersion;
        }

        /// <param name="texcoords">Per atom; empty: none.</param>
        public void SetTexcoords(ReadOnlySpan<Vector2> texcoords)
        {
            if (texcoords.IsEmpty && _texcoords.Length == 0)
                return;
            _texcoords.CopyFrom(texcoords);
            ++TexcoordsVersion;
        }
    }
}
