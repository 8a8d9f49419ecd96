// SPDX-License-Identifier: MIT
using System;
using UnityEngine;
using UnityEngine.Rendering;
using Object = UnityEngine.Object;

namespace QuickSes
{
    /// <summary>
    /// Colours of atoms in a texture, one texel per atom, for shaders that look them up by the atom of a vertex: another
    /// colour then moves nothing but the texture. Alpha 0 stands for hidden atoms. Main thread only.
    /// </summary>
    /// <remarks>
    /// Atom i is texel (i % width, i / width). The shader finds texture and width in a property block of the renderer,
    /// beside whatever else is in it; width 0: there is no texture, vertices have colours.
    /// </remarks>
    internal sealed unsafe class AtomColorTexture : IDisposable
    {
        private const int SmallWidth = 1024, LargeWidth = 4096, ManyAtoms = SmallWidth * SmallWidth;
        private const uint AlphaMask = 0xff000000, LeastAlpha = 0x01000000;

        private static readonly int s_colors = Shader.PropertyToID("_QuickSesAtomColors");
        private static readonly int s_width = Shader.PropertyToID("_QuickSesAtomColorsWidth");

        private readonly NativeMemory _memory = new NativeMemory();
        private readonly UnmanagedBuffer<uint> _texels = new UnmanagedBuffer<uint>();
        private Texture2D _texture;
        private MaterialPropertyBlock _block;
        private Renderer _renderer; // that the texture was given to
        private AtomLook _look; // that is in the texture; the versions are its
        private uint _colorsVersion;
        private uint _visibleVersion;

        /// <summary>Whether a material takes colours from such a texture, and this machine can.</summary>
        public static bool IsUsedBy(Material material, int atoms) => material != null && material.HasProperty(s_colors) &&
            SystemInfo.SupportsVertexAttributeFormat(VertexAttributeFormat.UInt32, 1) &&
            HeightFor(atoms) <= SystemInfo.maxTextureSize;

        /// <summary>Lets a renderer have the colours of these atoms.</summary>
        /// <returns>Whether anything was copied.</returns>
        public bool Show(Renderer renderer, AtomLook look)
        {
            bool isNew = _texture == null || look != _look || look.ColorsVersion != _colorsVersion ||
                look.VisibleVersion != _visibleVersion;
            if (isNew)
                Fill(look);
            Bind(renderer, _texture, _texture.width);
            return isNew;
        }

        /// <summary>The vertices of what is shown have colours.</summary>
        public void Hide()
        {
            if (_renderer != null)
                Bind(_renderer, Texture2D.whiteTexture, 0);
            _renderer = null;
            Free();
        }

        public void Dispose()
        {
            Free();
            _renderer = null;
            _texels.Dispose();
            _memory.Dispose();
        }

        private static int WidthFor(int atoms) => atoms <= ManyAtoms ? SmallWidth : LargeWidth;

        private static int HeightFor(int atoms) => Math.Max(1, (atoms + WidthFor(atoms) - 1) / WidthFor(atoms));

        private void Fill(AtomLook look)
        {
            int width = WidthFor(look.Count), height = HeightFor(look.Count);
            if (_texture == null || _texture.width != width || _texture.height != height)
            {
                Free();
                _texture = new Texture2D(width, height, TextureFormat.RGBA32, false, false)
                {
                    name = "Colours of atoms", hideFlags = HideFlags.DontSave, filterMode = FilterMode.Point,
                    wrapMode = TextureWrapMode.Clamp
                };
                _texels.Resize(width * height).Clear();
            }
            uint* texels = _texels.Pointer;
            fixed (uint* colors = look.Colors)
            fixed (byte* visible = look.Visible)
                for (int atom = 0; atom < look.Count; ++atom)
                {
                    uint color = colors[atom];
                    if (visible != null && visible[atom] == 0)
                        texels[atom] = color & ~AlphaMask;
                    else
                        texels[atom] = (color & AlphaMask) == 0 ? color | LeastAlpha : color;
                }
            _texture.SetPixelData(_memory.View<uint>(texels, width * height), 0);
            _texture.Apply(false, false);
            _look = look;
            _colorsVersion = look.ColorsVersion;
            _visibleVersion = look.VisibleVersion;
        }

        // Others may use the block as well, or have replaced it.
        private void Bind(Renderer renderer, Texture texture, float width)
        {
            _block ??= new MaterialPropertyBlock();
            renderer.GetPropertyBlock(_block);
            if (_block.GetTexture(s_colors) == texture && _block.GetFloat(s_width) == width)
                return;
            _block.SetTexture(s_colors, texture);
            _block.SetFloat(s_width, width);
            renderer.SetPropertyBlock(_block);
            _renderer = renderer;
        }

        private void Free()
        {
            if (_texture != null)
                Object.DestroyImmediate(_texture);
            _texture = null;
            _look = null;
        }
    }
}
