// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What goes wrong is told, once, and nothing else suffers from it.</summary>
    internal sealed class FailureTest
    {
        private const string NoFile = "/no/such/folder/molecule.pdb";

        private SurfaceRig _rig;

        [TearDown]
        public void TearDown() => _rig?.Dispose();

        [UnityTest]
        public IEnumerator ASourceThatFailsEndsTheJobOfTheAtomsBefore()
        {
            _rig = SurfaceRig.WithBlob(3000, 1);
            yield return SurfaceRig.Until(() => _rig.Levels.Count > 0);
            _rig.Surface.Source.SetFile(NoFile);
            Assert.That(_rig.Surface.LoadSource(), Is.False);
            int levels = _rig.Levels.Count, finished = _rig.Finished;
            yield return SurfaceRig.Frames(50);
            Assert.That(_rig.Surface.IsBusy, Is.False);
            Assert.That(_rig.Surface.LastError.Status, Is.EqualTo(QuickSesStatus.FileError));
            Assert.That(_rig.Failures.Count, Is.EqualTo(1));
            Assert.That(_rig.Failures[0].Message, Does.Contain(NoFile));
            Assert.That(_rig.Levels.Count, Is.EqualTo(levels));
            Assert.That(_rig.Finished, Is.EqualTo(finished));
        }

        [UnityTest]
        public IEnumerator ASourceThatFailsIsNoReasonToAskForAtoms()
        {
            _rig = new SurfaceRig();
            _rig.Surface.Source.SetFile(NoFile);
            Assert.That(_rig.Surface.ComputeNow(), Is.False);
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Requests, Is.EqualTo(0));
            Assert.That(_rig.Failures, Is.Not.Empty);
        }

        [UnityTest]
        public IEnumerator BadFramesDontFreezeThePictureOfGoodOnes()
        {
            TestMolecules.Blob(2000, 2, out Vector3[] positions, out float[] radii);
            var bad = (Vector3[])positions.Clone();
            bad[3].x = float.NaN;
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            _rig.Levels.Clear();
            int frames = 0;
            yield return SurfaceRig.Until(() =>
            {
                ++frames;
                _rig.Surface.SetPositions(frames % 2 == 0 ? TestMolecules.Moved(positions, frames) : bad);
                return _rig.Levels.Count >= 10;
            });
            Assert.That(_rig.Failures, Is.Not.Empty);
            Assert.That(_rig.Levels, Has.All.Matches<SurfaceLevel>(level => level.VertexCount > 0));
        }

        [UnityTest]
        public IEnumerator BadFramesAreOneLineInTheLogUntilAGoodOneComes()
        {
            TestMolecules.Blob(40, 2, out Vector3[] positions, out float[] radii);
            var scene = new GameObject("quiet");
            var surface = scene.AddComponent<MolecularSurface>();
            int shown = 0;
            surface.SurfaceUpdated += level => ++shown;
            surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => shown > 0 && !surface.IsBusy);
            for (int series = 0; series < 2; ++series)
            {
                LogAssert.Expect(LogType.Error, new Regex("^quiet: .*position")); // one: another would fail the test
                for (int frame = 0; frame < 60; ++frame)
                {
                    var bad = (Vector3[])positions.Clone();
                    bad[frame % 40].x = float.NaN;
                    surface.SetPositions(bad);
                    yield return SurfaceRig.Until(() => !surface.IsBusy);
                    Assert.That(surface.LastError.Message, Is.Not.Empty);
                }
                shown = 0;
                surface.SetPositions(positions);
                yield return SurfaceRig.Until(() => shown > 0 && !surface.IsBusy);
            }
            UnityEngine.Object.DestroyImmediate(scene);
        }

        [Test]
        public void FilesThatCantBeReadAreALineEachInTheLog()
        {
            var scene = new GameObject("quiet");
            var surface = scene.AddComponent<MolecularSurface>();
            foreach (string file in new[] { NoFile, NoFile + ".gz" })
            {
                LogAssert.Expect(LogType.Error, new Regex("^quiet: .*" + Regex.Escape($"'{file}'")));
                surface.Source.SetFile(file);
                Assert.That(surface.LoadSource(), Is.False);
                Assert.That(surface.LoadSource(), Is.False); // another line would fail the test
            }
            UnityEngine.Object.DestroyImmediate(scene);
        }

        [UnityTest]
        public IEnumerator AMeshThatCantBeWrittenIsAFailure()
        {
            _rig = SurfaceRig.WithBlob(40, 3);
            yield return _rig.Settle();
            _rig.Surface.Mesh.UploadMeshData(true);
            LogAssert.ignoreFailingMessages = true; // the engine logs it as well
            _rig.Surface.Recompute();
            yield return _rig.Settle();
            LogAssert.ignoreFailingMessages = false;
            Assert.That(_rig.Failures.Count, Is.EqualTo(1));
            Assert.That(_rig.Surface.LastError.Status, Is.EqualTo(QuickSesStatus.InternalError));
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator ADestroyedMeshIsMadeAnew()
        {
            _rig = SurfaceRig.WithBlob(40, 5);
            yield return _rig.Settle();
            UnityEngine.Object.DestroyImmediate(_rig.Surface.Mesh);
            _rig.Surface.Recompute();
            yield return _rig.Settle();
            Mesh shown = _rig.GameObject.GetComponent<MeshFilter>().sharedMesh;
            Assert.That(shown == _rig.Surface.Mesh);
            Assert.That(shown.vertexCount, Is.GreaterThan(0));
        }
    }
}
