// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>The player through reloads of the domain, in edit mode and at the end of the program.</summary>
    internal sealed class PlayerDomainTest
    {
        [SetUp]
        public void TidyUpAsTheEditorDoes() => Engine.BeforeReload += DomainLifeCycle.OnDomainUnloads;

        [UnityTest]
        public IEnumerator AReloadGoesOnWhereItWas()
        {
            using (var playing = new PlayerFixture())
            {
                playing.UseEnsemble(20);
                playing.Load();
                playing.Player.Frame = 7;
                playing.WaitUntilShown(7);
                Structure before = playing.Player.Structure;
                Engine.Reload();
                Assert.That(() => before.AtomCount, Throws.TypeOf<System.ObjectDisposedException>());
                yield return SurfaceRig.Until(() => playing.Player.ShownFrame >= 0);
                playing.AssertShows(7);
            }
        }

        [UnityTest]
        public IEnumerator AReloadWhileItPlaysIsSurvived()
        {
            for (int frames = 0; frames < 4; ++frames)
            {
                using (var playing = new PlayerFixture())
                {
                    playing.UseEnsemble(20);
                    playing.Player.PlayOnEnable = true;
                    Assert.That(playing.Player.Load(), Is.True);
                    playing.Player.Play();
                    yield return SurfaceRig.Frames(frames);
                    Engine.Reload();
                    Assert.That(playing.Player.IsPlaying, Is.True);
                    yield return SurfaceRig.Until(() => playing.Player.ShownFrame >= 0);
                    playing.AssertShows(playing.Player.ShownFrame);
                }
            }
        }

        [UnityTest]
        public IEnumerator EditModeScrubsButDoesNotPlay()
        {
            Engine.EnterEditMode();
            using (var playing = new PlayerFixture())
            {
                playing.UseEnsemble(20);
                Assert.That(playing.Player.Load(), Is.True);
                playing.Player.Play();
                yield return SurfaceRig.Until(() => playing.Player.ShownFrame >= 0);
                yield return SurfaceRig.Frames(5);
                playing.AssertShows(0);
                playing.Player.Frame = 13;
                yield return SurfaceRig.Until(() => playing.Player.ShownFrame == 13);
                playing.AssertShows(13);
            }
        }

        [UnityTest]
        public IEnumerator APrefabThatIsEditedDoesNotPlay()
        {
            using (var playing = new PlayerFixture())
            {
                Engine.OpenAsPrefab(playing.GameObject);
                playing.UseEnsemble(20);
                playing.Player.FramesPerSecond = 1000;
                Assert.That(playing.Player.Load(), Is.True);
                playing.Player.Play();
                yield return SurfaceRig.Until(() => playing.Player.ShownFrame >= 0);
                yield return SurfaceRig.Frames(5);
                Assert.That(playing.Shown, Is.EqualTo(new[] { 0 }));
            }
        }

        [Test]
        public void AReloadLeavesNoThreadOfADisabledPlayer()
        {
            using (var playing = new PlayerFixture())
            {
                playing.UseEnsemble(20);
                playing.Player.enabled = false;
                Assert.That(playing.Player.Load(), Is.True);
                Assert.That(playing.Player.IsLoading || playing.Player.Structure != null, Is.False);
                Engine.Reload();
                Assert.That(playing.Player.IsLoading || playing.Player.Structure != null, Is.False);
            }
        }

        [Test]
        public void QuittingClosesTheStructure()
        {
            var playing = new PlayerFixture();
            playing.UseEnsemble(20);
            playing.Load();
            Structure structure = playing.Player.Structure;
            Engine.Quit();
            BackgroundThread.SendAllAway();
            Assert.That(() => structure.AtomCount, Throws.TypeOf<System.ObjectDisposedException>());
            Assert.That(playing.Player == null, Is.True);
        }
    }
}
