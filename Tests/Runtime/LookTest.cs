// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Colours, hidden atoms, texture coordinates: in vertices or in a texture, and nothing is computed.</summary>
    internal sealed class LookTest
    {
        private const int Atoms = 60;

        private static readonly int s_colors = Shader.PropertyToID("_QuickSesAtomColors");
        private static readonly int s_width = Shader.PropertyToID("_QuickSesAtomColorsWidth");

        private SurfaceRig _rig;
        private double _budget;
        private uint _jobs;

        [SetUp]
        public void SetUp() => _budget = SurfaceScheduler.UploadBudget;

        [TearDown]
        public void TearDown()
        {
            SurfaceScheduler.UploadBudget = _budget;
            _rig?.Dispose();
        }

        [UnityTest]
        public IEnumerator ColoursOfVerticesAreThoseOfTheirAtoms([Values(1e-6, 2, 0)] double budget)
        {
            yield return Show(AtomColoring.Vertices);
            SurfaceScheduler.UploadBudget = budget;
            Color32[] colors = SomeColors(1);
            _rig.Surface.SetColors(colors);
            Assert.That(_rig.Surface.IsBusy, "it has to be painted");
            yield return _rig.Settle();
            AssertColors(colors);

            colors[17] = new Color32(1, 2, 3, 255); // one only
            _rig.Surface.SetColors(colors);
            yield return _rig.Settle();
            AssertColors(colors);

            _rig.Surface.SetColors(ReadOnlySpan<Color32>.Empty);
            _rig.Surface.BaseColor = new Color32(1, 2, 3, 255);
            yield return _rig.Settle();
            Assert.That(Shown(_rig.Surface.Mesh.colors32), Is.All.EqualTo(new Color32(1, 2, 3, 255)));
            AssertNothingWasComputed();
        }

        [UnityTest]
        public IEnumerator TheSameColoursAreNoWork()
        {
            yield return Show(AtomColoring.Vertices);
            _rig.Surface.SetColors(SomeColors(1));
            yield return _rig.Settle();
            _rig.Surface.SetColors(SomeColors(1));
            _rig.Surface.SetVisible(Array.ConvertAll(new bool[Atoms], hidden => true));
            Assert.That(_rig.Surface.IsBusy, Is.False);
        }

        [UnityTest]
        public IEnumerator ColoursThatChangeInEveryFrameComeThrough()
        {
            yield return Show(AtomColoring.Vertices);
            SurfaceScheduler.UploadBudget = 1e-6;
            Color32[] colors = null;
            for (int frame = 0; frame < 30; ++frame)
            {
                _rig.Surface.SetColors(colors = SomeColors(frame));
                yield return null;
            }
            yield return _rig.Settle();
            AssertColors(colors);
        }

        [UnityTest]
        public IEnumerator NewSurfacesHaveTheNewestColours()
        {
            yield return Show(AtomColoring.Vertices);
            TestMolecules.Blob(Atoms, 1, out Vector3[] positions, out _);
            for (int frame = 0; frame < 20; ++frame)
            {
                _rig.Surface.SetPositions(TestMolecules.Moved(positions, frame));
                _rig.Surface.SetColors(SomeColors(frame));
                yield return null;
            }
            yield return _rig.Settle();
            AssertColors(SomeColors(19));
        }

        [UnityTest]
        public IEnumerator TheMaterialOfThePackageTakesColoursFromATexture()
        {
            yield return Show(AtomColoring.Auto);
            Mesh mesh = _rig.Surface.Mesh;
            if (!mesh.HasVertexAttribute(VertexAttribute.TexCoord7))
                Assert.Ignore("this machine's graphics have no integer attributes");
            Assert.That(mesh.HasVertexAttribute(VertexAttribute.Color), Is.False);
            Assert.That(mesh.GetVertexAttributeFormat(VertexAttribute.TexCoord7),
                Is.EqualTo(VertexAttributeFormat.UInt32));
            Color32[] colors = SomeColors(1);
            _rig.Surface.SetColors(colors);
            yield return _rig.Settle();
            AssertTexels(colors, null);

            var visible = new bool[Atoms];
            for (int i = 0; i < Atoms; ++i)
                visible[i] = i % 3 != 0;
            colors[1].a = 0; // transparent, not hidden
            _rig.Surface.SetColors(colors);
            _rig.Surface.SetVisible(visible);
            yield return null;
            yield return null;
            AssertTexels(colors, visible);
            Assert.That(_rig.Surface.Mesh, Is.SameAs(mesh));
            Assert.That(_rig.Surface.IsBusy, Is.False, "and there is nothing to upload");
            AssertNothingWasComputed();
        }

        [UnityTest]
        public IEnumerator AnotherMaterialMovesTheColoursIntoTheVertices()
        {
            yield return Show(AtomColoring.Auto);
            _rig.Surface.SetColors(SomeColors(2));
            yield return _rig.Settle();
            var plain = new GameObject("plain").AddComponent<MeshRenderer>();
            var renderer = _rig.GameObject.GetComponent<MeshRenderer>();
            Material before = renderer.sharedMaterial;
            renderer.sharedMaterial = plain.sharedMaterial; // none
            yield return null;
            yield return null;
            yield return _rig.Settle();
            AssertColors(SomeColors(2));
            Assert.That(Block().GetFloat(s_width), Is.EqualTo(0));
            renderer.sharedMaterial = before;
            yield return null;
            yield return null;
            yield return _rig.Settle();
            AssertTexels(SomeColors(2), null);
            AssertNothingWasComputed();
            UnityEngine.Object.DestroyImmediate(plain.gameObject);
        }

        [UnityTest]
        public IEnumerator PropertiesOfOthersStay()
        {
            yield return Show(AtomColoring.Texture);
            int theirs = Shader.PropertyToID("_Smoothness");
            var block = new MaterialPropertyBlock();
            block.SetFloat(theirs, 0.7f);
            var renderer = _rig.GameObject.GetComponent<MeshRenderer>();
            renderer.SetPropertyBlock(block); // in the place of ours
            yield return null;
            yield return null;
            Assert.That(Block().GetFloat(theirs), Is.EqualTo(0.7f));
            AssertTexels(null, null);
            renderer.SetPropertyBlock(null);
            yield return null;
            yield return null;
            AssertTexels(null, null);
            _rig.Surface.Coloring = AtomColoring.Vertices;
            yield return null;
            yield return _rig.Settle();
            Assert.That(Block().GetFloat(s_width), Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator AMeshOfSomebodyElsesHasItsOwnColours([Values] bool isDisabledAtOnce)
        {
            yield return Show(AtomColoring.Texture);
            AssertTexels(null, null);
            var filter = _rig.GameObject.GetComponent<MeshFilter>();
            Mesh own = filter.sharedMesh;
            var theirs = new Mesh { vertices = new[] { Vector3.zero, Vector3.right, Vector3.up }, triangles = new[] { 0, 2, 1 } };
            filter.sharedMesh = theirs;
            if (isDisabledAtOnce)
                _rig.Surface.enabled = false;
            yield return null;
            yield return null;
            Assert.That(filter.sharedMesh, Is.SameAs(theirs));
            Assert.That(Block().GetFloat(s_width), Is.EqualTo(0));
            if (isDisabledAtOnce)
            {
                _rig.Surface.enabled = true; // puts its own there
            }
            else
            {
                _rig.Surface.SetColors(SomeColors(3));
                yield return _rig.Settle();
                Assert.That(Block().GetFloat(s_width), Is.EqualTo(0));
                filter.sharedMesh = own;
            }
            yield return null;
            yield return null;
            Assert.That(filter.sharedMesh, Is.SameAs(own));
            AssertTexels(isDisabledAtOnce ? null : SomeColors(3), null);
            UnityEngine.Object.DestroyImmediate(theirs);
        }

        [UnityTest]
        public IEnumerator OtherAtomsHaveTheirColoursWhenTheyAreShown()
        {
            _rig = SurfaceRig.WithBlob(Atoms + 1, 1);
            _rig.Surface.Coloring = AtomColoring.Texture;
            yield return _rig.Settle();
            int before = _rig.Levels.Count;
            TestMolecules.Blob(Atoms, 2, out Vector3[] positions, out float[] radii);
            _rig.Surface.SetAtoms(positions, radii);
            _rig.Surface.SetColors(SomeColors(2));
            yield return SurfaceRig.Until(() => _rig.Levels.Count > before);
            AssertTexels(SomeColors(2), null); // in the same frame
        }

        [UnityTest]
        public IEnumerator ARendererWithoutTheComponentHasNoTextureOfIt()
        {
            yield return Show(AtomColoring.Texture);
            AssertTexels(null, null);
            UnityEngine.Object.DestroyImmediate(_rig.Surface);
            Assert.That(Block().GetFloat(s_width), Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator SwitchedOffItKeepsItsColours()
        {
            yield return Show(AtomColoring.Texture);
            _rig.Surface.SetColors(SomeColors(1));
            yield return null;
            yield return _rig.Settle();
            _rig.Surface.enabled = false;
            yield return null;
            AssertTexels(SomeColors(1), null);
        }

        [UnityTest]
        public IEnumerator HiddenAtomsAreLeftOutAsTheLibraryDoes([Values(1e-6, 0)] double budget)
        {
            yield return Show(AtomColoring.Vertices);
            double volume = _rig.Surface.Volume;
            SurfaceScheduler.UploadBudget = budget;
            TestMolecules.Blob(Atoms, 1, out Vector3[] positions, out float[] radii);
            var visible = new bool[Atoms];
            for (int round = 1; round < 4; ++round)
            {
                for (int i = 0; i < Atoms; ++i)
                    visible[i] = i % (round + 1) != 0;
                _rig.Surface.SetVisible(visible);
                yield return _rig.Settle();
                Assert.That(_rig.Surface.Mesh.triangles, Is.Not.Empty);
                SurfaceMeshes.AssertShows(_rig.Surface, positions, radii, false, visible);
                Assert.That(_rig.Surface.Volume, Is.EqualTo(volume), "it is that of the whole");
            }
            _rig.Surface.SetVisible(Array.Empty<bool>());
            yield return _rig.Settle();
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
            AssertNothingWasComputed();
        }

        [UnityTest]
        public IEnumerator TextureCoordinatesComeAndGoWithoutAComputation([Values] bool isOccluded)
        {
            yield return Show(AtomColoring.Vertices);
            _rig.Surface.AmbientOcclusion = isOccluded;
            yield return _rig.Settle();
            _jobs = SurfaceScheduler.LastJob;
            Vector2[] occlusion = _rig.Surface.Mesh.uv2;
            var texcoords = new Vector2[Atoms];
            for (int round = 0; round < 2; ++round)
            {
                for (int i = 0; i < Atoms; ++i)
                    texcoords[i] = new Vector2(i, round);
                _rig.Surface.SetTexcoords(texcoords);
                yield return _rig.Settle();
                Vector2[] shown = _rig.Surface.Mesh.uv2;
                for (int v = 0; v < shown.Length; ++v)
                    Assert.That(shown[v], Is.EqualTo(texcoords[_rig.Surface.OwnerAtomAt(v)]));
            }
            _rig.Surface.SetTexcoords(Array.Empty<Vector2>());
            yield return _rig.Settle();
            Assert.That(_rig.Surface.Mesh.HasVertexAttribute(VertexAttribute.TexCoord1), Is.EqualTo(isOccluded));
            Assert.That(_rig.Surface.Mesh.uv2, Is.EqualTo(occlusion));
            AssertNothingWasComputed();
        }

        [UnityTest]
        public IEnumerator CompactVerticesShowTheSameSurface()
        {
            yield return Show(AtomColoring.Vertices);
            Vector3[] positions = _rig.Surface.Mesh.vertices, normals = _rig.Surface.Mesh.normals;
            _rig.Surface.CompactVertices = true;
            yield return _rig.Settle();
            Mesh mesh = _rig.Surface.Mesh;
            Assert.That(mesh.GetVertexBufferStride(0), Is.EqualTo(16));
            Assert.That(mesh.GetVertexAttributeFormat(VertexAttribute.Normal), Is.EqualTo(VertexAttributeFormat.SNorm8));
            Assert.That(mesh.vertices, Is.EqualTo(positions));
            Vector3[] rounded = mesh.normals;
            for (int v = 0; v < rounded.Length; ++v)
                Assert.That((rounded[v] - normals[v]).magnitude, Is.LessThan(0.01));
        }

        [UnityTest]
        public IEnumerator HiddenAtomsLetRaysThrough()
        {
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(new[] { Vector3.zero, new Vector3(0, 0, 9) }, new[] { 2f, 2f });
            yield return _rig.Settle();
            var ray = new Ray(new Vector3(0.1f, 0.1f, -20), Vector3.forward);
            Assert.That(_rig.Surface.TryPick(ray, out int atom, out _));
            Assert.That(atom, Is.EqualTo(0));
            _rig.Surface.SetVisible(new[] { false, true });
            yield return _rig.Settle();
            Assert.That(_rig.Surface.TryPick(ray, out atom, out Vector3 point));
            Assert.That(atom, Is.EqualTo(1));
            Assert.That(point.z, Is.EqualTo(7).Within(0.1));
        }

        [UnityTest]
        public IEnumerator ACopyHasColoursHoweverTheSurfaceIsColoured(
            [Values(AtomColoring.Vertices, AtomColoring.Texture)] AtomColoring coloring)
        {
            yield return Show(coloring);
            Color32[] colors = SomeColors(3);
            var visible = new bool[Atoms];
            for (int i = 0; i < Atoms; ++i)
                visible[i] = i < Atoms / 2;
            _rig.Surface.SetColors(colors);
            _rig.Surface.SetVisible(visible);
            var copy = new Mesh();
            _rig.Surface.CopyTo(copy);
            Color32[] painted = copy.colors32;
            for (int v = 0; v < painted.Length; ++v)
                Assert.That(painted[v], Is.EqualTo(colors[_rig.Surface.OwnerAtomAt(v)]));
            foreach (int vertex in copy.triangles)
                Assert.That(visible[_rig.Surface.OwnerAtomAt(vertex)]);
            Assert.That(copy.triangles, Is.Not.Empty);
            Assert.That(copy.HasVertexAttribute(VertexAttribute.TexCoord7), Is.False);
            int vertices = copy.vertexCount;
            copy.UploadMeshData(true);
            Assert.That(() => _rig.Surface.CopyTo(copy), Throws.InvalidOperationException);
            Assert.That(copy.vertexCount, Is.EqualTo(vertices), "what can't be replaced stays");
            UnityEngine.Object.DestroyImmediate(copy);
        }

        private IEnumerator Show(AtomColoring coloring)
        {
            _rig = SurfaceRig.WithBlob(Atoms, 1);
            _rig.Surface.Coloring = coloring;
            yield return _rig.Settle();
            _jobs = SurfaceScheduler.LastJob;
        }

        private static Color32[] SomeColors(int seed)
        {
            var colors = new Color32[Atoms];
            for (int i = 0; i < Atoms; ++i)
                colors[i] = new Color32((byte)(4 * i), (byte)(255 - 4 * i), (byte)seed, 255);
            return colors;
        }

        private T[] Shown<T>(T[] ofMesh) => SurfaceMeshes.First(ofMesh, _rig.Surface.CurrentLevel.VertexCount);

        private void AssertColors(Color32[] colors)
        {
            Color32[] shown = Shown(_rig.Surface.Mesh.colors32);
            Assert.That(shown, Is.Not.Empty);
            for (int v = 0; v < shown.Length; ++v)
                Assert.That(shown[v], Is.EqualTo(colors[_rig.Surface.OwnerAtomAt(v)]), $"vertex {v}");
        }

        private MaterialPropertyBlock Block()
        {
            var block = new MaterialPropertyBlock();
            _rig.GameObject.GetComponent<MeshRenderer>().GetPropertyBlock(block);
            return block;
        }

        private void AssertTexels(Color32[] colors, bool[] visible)
        {
            var texture = (Texture2D)Block().GetTexture(s_colors);
            Assert.That(texture != null);
            Assert.That(Block().GetFloat(s_width), Is.EqualTo(texture.width));
            Assert.That(texture.width * texture.height, Is.GreaterThanOrEqualTo(Atoms));
            Assert.That(texture.filterMode, Is.EqualTo(FilterMode.Point));
            Color32[] texels = texture.GetPixels32();
            for (int i = 0; i < Atoms && colors != null; ++i)
            {
                bool isVisible = visible == null || visible[i];
                byte alpha = isVisible ? Math.Max((byte)1, colors[i].a) : (byte)0;
                Assert.That(texels[i], Is.EqualTo(new Color32(colors[i].r, colors[i].g, colors[i].b, alpha)));
            }
        }

        private void AssertNothingWasComputed() => Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(_jobs));
    }
}
