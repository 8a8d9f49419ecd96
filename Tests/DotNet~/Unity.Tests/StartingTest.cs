// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>
    /// CUDA takes a second to start, or a minute where the driver compiles the kernels. Meanwhile frames go on: no call that
    /// waits for it is made by the main thread.
    /// </summary>
    internal sealed class StartingTest
    {
        [SetUp]
        public void SetUp() => SurfaceScheduler.ReleaseContexts();

        [TearDown]
        public void TearDown() => NativeGate.Open();

        [UnityTest]
        public IEnumerator FramesGoOn()
        {
            TestMolecules.Blob(300, 1, out Vector3[] positions, out float[] radii);
            NativeGate.Close();
            Assert.That(MolecularSurface.IsSupported(out string reason), reason);
            var rig = new SurfaceRig();
            Assert.That(rig.Surface.IsStarting, Is.False, "there is nothing to compute");
            rig.Surface.SetAtoms(positions, radii);
            for (int frame = 0; frame < 50; ++frame)
            {
                positions[0] += new Vector3(0.01f, 0, 0);
                rig.Surface.SetPositions(positions);
                yield return null;
                Assert.That(rig.Surface.IsStarting && rig.Surface.IsBusy);
                Assert.That(rig.Surface.Progress, Is.EqualTo(0));
            }
            yield return SurfaceRig.Until(() => NativeGate.Waiting == 1); // the thread that makes the context
            Assert.That(rig.Levels, Is.Empty);
            Assert.That(rig.Failures, Is.Empty);

            Assert.That(NativeGate.Open(), Is.EqualTo(0), "calls that the main thread would have waited for");
            yield return rig.Settle();
            Assert.That(rig.Surface.IsStarting, Is.False);
            SurfaceMeshes.AssertShows(rig.Surface, positions, radii);
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator WhoLeavesDoesNotWaitEither()
        {
            NativeGate.Close();
            SurfaceRig rig = SurfaceRig.WithBlob(300, 1);
            yield return SurfaceRig.Until(() => NativeGate.Waiting > 0);
            rig.Surface.enabled = false;
            yield return null;
            Assert.That(rig.Surface.IsStarting, Is.False);
            rig.Surface.enabled = true;
            yield return null;
            Assert.That(rig.Surface.IsStarting);
            rig.Dispose();
            yield return SurfaceRig.Frames(3);
            Assert.That(NativeGate.Open(), Is.EqualTo(0));
            yield return SurfaceRig.Until(() => ContextSlot.NativeContexts == 0);
        }

        [UnityTest]
        public IEnumerator PlayModeBeginsWhileItStarts()
        {
            Engine.EnterEditMode();
            NativeGate.Close();
            SurfaceRig edited = SurfaceRig.WithBlob(300, 1);
            yield return SurfaceRig.Until(() => NativeGate.Waiting > 0);
            Engine.EnterPlayModeWithoutReload(typeof(MolecularSurface).Assembly);
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0), "the context of edit mode is taken back");
            Assert.That(edited.GameObject == null);
            SurfaceRig rig = SurfaceRig.WithBlob(300, 1);
            yield return SurfaceRig.Until(() => NativeGate.Waiting > 1);
            Assert.That(rig.Surface.IsStarting);
            Assert.That(NativeGate.Open(), Is.EqualTo(0));
            yield return rig.Settle();
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator ToolsThatWaitMayTellAndStop()
        {
            SurfaceRig rig = SurfaceRig.WithBlob(300, 1);
            NativeGate.Close();
            int looks = 0;
            Assert.That(rig.Surface.ComputeWhile(() => ++looks < 3), Is.False);
            Assert.That(looks, Is.EqualTo(3));
            Assert.That(rig.Surface.LastError.Status, Is.EqualTo(QuickSesStatus.Cancelled));
            Assert.That(rig.Failures, Is.Empty, "who stops it is told already");
            Assert.That(rig.Surface.IsBusy, "its own surface still comes");
            Assert.That(NativeGate.Open(), Is.EqualTo(0));
            yield return rig.Settle();
            Assert.That(rig.Surface.CurrentLevel.IsFinest);
            Assert.That(rig.Surface.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(rig.Surface.ComputeWhile(() => true), Is.True);
            Assert.That(rig.Surface.CurrentLevel.IsFinest);
            rig.Dispose();
        }
    }
}
