// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Collections.Generic;
using Unity.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>What rests is sharp where the surface is, unless somebody does not want that; what moves is not.</summary>
    internal sealed class SharpCreasesTest
    {
        private const int Atoms = 200;

        private SurfaceRig _rig;
        private Vector3[] _positions;
        private float[] _radii;

        [SetUp]
        public void SetUp()
        {
            TestMolecules.Blob(Atoms, 1, out _positions, out _radii);
            _rig = new SurfaceRig();
        }

        [TearDown]
        public void TearDown() => _rig.Dispose();

        [UnityTest]
        public IEnumerator WhatRestsIsSharpByDefault(
            [Values(SurfaceKind.Ses, SurfaceKind.Sas, SurfaceKind.Vdw)] SurfaceKind kind)
        {
            _rig.Surface.Surface = kind;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            SurfaceLevel level = _rig.Surface.CurrentLevel;
            Assert.That(level.HasCreases);
            Assert.That(_rig.Levels.FindAll(each => each.HasCreases).Count, Is.EqualTo(1), "coarser levels are not");
            Assert.That(_rig.Surface.Repeated.Length, Is.InRange(1, level.VertexCount / 2));
            AssertEachSideHasANormal();
            Mesh mesh = _rig.Surface.Mesh;
            Assert.That(SurfaceMeshes.IsClosed(mesh, _rig.Surface));
            Assert.That(mesh.vertexCount, Is.EqualTo(level.VertexCount), "buffers are exact");
            Assert.That(mesh.GetIndexCount(0), Is.EqualTo(3 * level.TriangleCount));
            Assert.That(level.MeshBytes, Is.GreaterThanOrEqualTo(
                28UL * (ulong)level.VertexCount + 12UL * (ulong)level.TriangleCount));
            SurfaceMeshes.AssertShows(_rig.Surface, _positions, _radii);
        }

        [UnityTest]
        public IEnumerator WhatMovesIsNotUntilItRests([Values(0, 33)] float frameBudget)
        {
            _rig.Surface.FrameBudget = frameBudget;
            _rig.Surface.RestDelay = 1e6f;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            _rig.Levels.Clear();
            Vector3[] moved = null;
            for (int frame = 0; frame < 20; ++frame)
            {
                moved = TestMolecules.Moved(_positions, frame);
                _rig.Surface.SetPositions(moved);
                int shown = _rig.Levels.Count;
                yield return SurfaceRig.Until(() => _rig.Levels.Count > shown);
            }
            yield return SurfaceRig.Until(() => _rig.Surface.CurrentLevel.IsOfNewestAtoms);
            Assert.That(_rig.Levels, Has.None.Matches<SurfaceLevel>(each => each.HasCreases));
            Assert.That(_rig.Surface.Repeated.Length, Is.EqualTo(0));
            Assert.That(_rig.Finished, Is.EqualTo(1), "of the atoms before they moved");
            Assert.That(_rig.Surface.IsBusy, "there is more to come");
            _rig.Surface.RestDelay = 0;
            yield return _rig.Settle();
            Assert.That(_rig.Finished, Is.EqualTo(2));
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(_rig.Surface.CurrentLevel.VertexCount));
            SurfaceMeshes.AssertShows(_rig.Surface, moved, _radii);
            _rig.Surface.SetPositions(_positions);
            Assert.That(_rig.Surface.ComputeNow(), "tools don't wait for rest");
            SurfaceMeshes.AssertShows(_rig.Surface, _positions, _radii);
        }

        [UnityTest]
        public IEnumerator TheSwitchHoldsForWhatIsShown()
        {
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            int sharp = _rig.Surface.CurrentLevel.VertexCount;
            _rig.Surface.SharpCreases = false;
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.HasCreases, Is.False);
            Assert.That(_rig.Surface.CurrentLevel.VertexCount, Is.LessThan(sharp));
            Assert.That(SurfaceMeshes.IsClosed(_rig.Surface.Mesh, _rig.Surface));
            SurfaceMeshes.AssertShows(_rig.Surface, _positions, _radii);
            _rig.Surface.SharpCreases = true;
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.VertexCount, Is.EqualTo(sharp));
        }

        [UnityTest]
        public IEnumerator TheGridMethodHasNone()
        {
            _rig.Surface.Method = SurfaceMethod.Grid;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            Assert.That(_rig.Failures, Is.Empty);
            Assert.That(_rig.Surface.CurrentLevel.IsFinest && !_rig.Surface.CurrentLevel.HasCreases);
            Assert.That(_rig.Finished, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator ACopyIsSharpAndClosedAsWell()
        {
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            var copy = new Mesh();
            _rig.Surface.CopyTo(copy);
            Assert.That(copy.vertexCount, Is.EqualTo(_rig.Surface.CurrentLevel.VertexCount));
            Assert.That(copy.normals, Is.EqualTo(_rig.Surface.Mesh.normals));
            Assert.That(SurfaceMeshes.IsClosed(copy, _rig.Surface));
            Object.DestroyImmediate(copy);
        }

        [UnityTest]
        public IEnumerator ShadersFindTheAtomOfEachSide()
        {
            _rig.Surface.Coloring = AtomColoring.Texture;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            using (Mesh.MeshDataArray data = Mesh.AcquireReadOnlyMeshData(_rig.Surface.Mesh))
            {
                Assert.That(_rig.Surface.Mesh.GetVertexAttributeStream(VertexAttribute.TexCoord7), Is.EqualTo(1));
                NativeArray<uint> atoms = data[0].GetVertexData<uint>(1);
                Assert.That(atoms.ToArray(), Is.EqualTo(_rig.Surface.Owners.ToArray()));
            }
        }

        // Vertices that stand for others are at their place and of their atom, are used, and look elsewhere.
        private void AssertEachSideHasANormal()
        {
            Mesh mesh = _rig.Surface.Mesh;
            Vector3[] vertices = mesh.vertices, normals = mesh.normals;
            ReadOnlySpan<uint> repeated = _rig.Surface.Repeated;
            int single = vertices.Length - repeated.Length;
            var used = new HashSet<int>(mesh.triangles);
            for (int k = 0; k < repeated.Length; ++k)
            {
                int other = (int)repeated[k], vertex = single + k;
                Assert.That(other, Is.LessThan(single));
                Assert.That(k == 0 || repeated[k - 1] < other, "in ascending order");
                Assert.That(vertices[vertex].Equals(vertices[other]));
                Assert.That(normals[vertex].Equals(normals[other]), Is.False);
                Assert.That(_rig.Surface.OwnerAtomAt(vertex), Is.EqualTo(_rig.Surface.OwnerAtomAt(other)));
                Assert.That(used.Contains(vertex) && used.Contains(other));
            }
        }
    }
}
