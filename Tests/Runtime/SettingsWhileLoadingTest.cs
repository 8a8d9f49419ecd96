// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What becomes of settings of a player that are changed between Load and the first frame.</summary>
    public sealed class SettingsWhileLoadingTest
    {
        private PlayerFixture _playing;

        private TrajectoryPlayer Player => _playing.Player;

        [SetUp]
        public void MakePlayer() => _playing = new PlayerFixture();

        [TearDown]
        public void DestroyPlayer() => _playing.Dispose();

        [UnityTest]
        public IEnumerator AColourSchemeHoldsAtOnce([Values] bool isEdited)
        {
            _playing.Surface.Coloring = AtomColoring.Vertices;
            _playing.UseEnsemble(3);
            Assert.That(Player.Load(), Is.True);
            if (isEdited)
            {
                Player.StructureSource.ColorScheme = AtomColorScheme.Uniform;
                Player.FollowEdits();
            }
            else
            {
                Player.ColorScheme = AtomColorScheme.Uniform;
            }
            yield return SurfaceRig.Until(() => Player.ShownFrame == 0 && !_playing.Surface.IsBusy);
            Assert.That(_playing.Surface.Mesh.colors32, Is.Not.Empty.And.All.EqualTo(_playing.Surface.BaseColor));
        }

        [Test]
        public void AllElseHoldsFromTheNextLoadOn()
        {
            List<Vector3[]> torn = TestFrames.Frames(2);
            for (int i = 3; i < TestFrames.AtomCount; ++i)
                torn[1][i].x -= 20;
            using (var folder = new TestFolder())
            {
                string file = folder.Write("md.dcd", TestFrames.Dcd(torn, new Vector3(20, 30, 40)));
                _playing.UseStructure();
                Player.TrajectorySource.SetFile(file);
                Assert.That(Player.Load(), Is.True);
                Player.Unwrap = true;
                Player.TrajectorySource.Format = TrajectoryFormat.Xtc;
                Player.TrajectorySource.Path = folder.Root + "/none.xtc";
                Player.Frame = 1;
                _playing.TickUntil(() => Player.ShownFrame == 1 || _playing.Failures.Count > 0, "it is shown");
                Assert.That(_playing.Failures, Is.Empty);
                _playing.AssertAt(torn[1], 0);
                _playing.Dispose(); // which lets go of the file
            }
        }
    }
}
