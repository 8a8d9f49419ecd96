// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What other scripts set in their LateUpdate is on its way in the same frame, whatever was there first.</summary>
    internal sealed class ExecutionOrderTest
    {
        private sealed class Feeder : MonoBehaviour
        {
            public Action Feed;

            private void LateUpdate() => Feed?.Invoke();
        }

        [UnityTest]
        public IEnumerator PositionsOfAScriptAre()
        {
            TestMolecules.Blob(40, 1, out Vector3[] positions, out _);
            using (SurfaceRig rig = SurfaceRig.WithBlob(40, 1))
            {
                var feeder = rig.GameObject.AddComponent<Feeder>();
                yield return rig.Settle();
                feeder.Feed = () => rig.Surface.SetPositions(TestMolecules.Moved(positions, 2));
                uint before = SurfaceScheduler.LastJob;
                Engine.Frame(0.02);
                Assert.That(SurfaceScheduler.LastJob, Is.Not.EqualTo(before));
            }
        }

        [UnityTest]
        public IEnumerator ThoseOfAPlayerThatIsAnimatedAre()
        {
            using (var playing = new PlayerFixture())
            {
                playing.UseEnsemble(3);
                playing.Load();
                foreach (int frame in new[] { 1, 0 }) // so that both are read
                {
                    playing.Player.Frame = frame;
                    playing.WaitUntilShown(frame);
                }
                yield return SurfaceRig.Until(() => !playing.Surface.IsBusy);
                Engine.Animating += () => Engine.Animate(playing.Player, "_frame", 1);
                uint before = SurfaceScheduler.LastJob;
                Engine.Frame(0.02);
                playing.AssertShows(1);
                Assert.That(SurfaceScheduler.LastJob, Is.Not.EqualTo(before));
            }
        }

        // A scene that is loaded, or a copy, wakes the player first.
        [UnityTest]
        public IEnumerator APlayerThatIsEnabledBeforeItsSurfacePlays()
        {
            var original = new GameObject("played");
            original.SetActive(false);
            original.AddComponent<TrajectoryPlayer>().PlayOnEnable = false;
            original.GetComponent<MolecularSurface>().Source.SetAsset(
                new TextAsset(TestFrames.Pdb(3)) { name = "ensemble.pdb" });
            original.SetActive(true);
            GameObject copy = UnityEngine.Object.Instantiate(original);
            UnityEngine.Object.DestroyImmediate(original);
            var player = copy.GetComponent<TrajectoryPlayer>();
            var surface = copy.GetComponent<MolecularSurface>();
            yield return SurfaceRig.Until(() => player.ShownFrame == 0 && !surface.IsBusy);
            Assert.That(surface.IsPlayed);
            Assert.That(surface.CurrentLevel.IsFinest);
            UnityEngine.Object.DestroyImmediate(copy);
        }
    }
}
