// SPDX-License-Identifier: MIT
using NUnit.Framework;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>The texture that has the colours of atoms, for molecules of all sizes.</summary>
    internal sealed class AtomColorTextureTest
    {
        private AtomColorTexture _texture;
        private MeshRenderer _renderer;

        [SetUp]
        public void SetUp()
        {
            _texture = new AtomColorTexture();
            _renderer = new GameObject("surface").AddComponent<MeshRenderer>();
        }

        [TearDown]
        public void TearDown()
        {
            _texture.Dispose();
            Object.DestroyImmediate(_renderer.gameObject);
        }

        [Test]
        public void ItHasRoomForEachMoleculeAndNotMuchMore()
        {
            const int many = 1024 * 1024;
            foreach ((int atoms, int width, int height) in new[]
                { (0, 1024, 1), (100, 1024, 1), (1024, 1024, 1), (1025, 1024, 2), (many, 1024, 1024),
                    (257 * 1024, 1024, 257), (many + 1, 4096, 257), (4096 * 1024, 4096, 1024), (3, 1024, 1) })
            {
                var look = new AtomLook(atoms, 0xff000000u + (uint)atoms);
                Assert.That(_texture.Show(_renderer, look), Is.True);
                var block = new MaterialPropertyBlock();
                _renderer.GetPropertyBlock(block);
                var shown = (Texture2D)block.GetTexture(Shader.PropertyToID("_QuickSesAtomColors"));
                Assert.That((shown.width, shown.height), Is.EqualTo((width, height)), $"{atoms} atoms");
                Assert.That(block.GetFloat(Shader.PropertyToID("_QuickSesAtomColorsWidth")), Is.EqualTo(width));
                if (atoms > 0)
                    Assert.That(shown.GetPixels32()[atoms - 1], Is.EqualTo(
                        new Color32((byte)atoms, (byte)(atoms >> 8), (byte)(atoms >> 16), 255)));
                Assert.That(_texture.Show(_renderer, look), Is.False, "it is there");
                look.Release();
            }
        }
    }
}
