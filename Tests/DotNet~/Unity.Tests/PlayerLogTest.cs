// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Text.RegularExpressions;
using System.Threading;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What a player logs where nobody listens to its failures.</summary>
    internal sealed class PlayerLogTest
    {
        private TestFolder _folder;
        private TrajectoryPlayer _player;

        [SetUp]
        public void MakePlayer()
        {
            _folder = new TestFolder();
            _player = new GameObject("quiet").AddComponent<TrajectoryPlayer>();
            _player.PlayOnEnable = false;
            _player.Pause();
            _player.StructureSource.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "structure.pdb" });
        }

        [TearDown]
        public void DestroyPlayer()
        {
            UnityEngine.Object.DestroyImmediate(_player.gameObject);
            _folder.Dispose();
        }

        [Test]
        public void DamagedFramesAreOneLineUntilAFileIsLoaded()
        {
            List<Vector3[]> frames = TestFrames.Frames(4);
            frames[1][3].y = frames[3][3].y = float.NaN;
            _player.TrajectorySource.SetFile(_folder.Write("md.dcd", TestFrames.Dcd(frames)));
            for (int load = 0; load < 2; ++load)
            {
                Assert.That(_player.Load());
                TickUntil(() => _player.ShownFrame == 0);
                LogAssert.Expect(LogType.Error, new Regex("^quiet: frame 1: ")); // one: another would fail the test
                foreach (int frame in new[] { 1, 3, 1 })
                {
                    _player.Frame = frame;
                    TickUntil(() => _player.LastError.Message.StartsWith($"frame {frame}: "));
                }
                _player.Frame = 0;
                TickUntil(() => _player.ShownFrame == 0);
            }
        }

        [Test]
        public void EachFileThatCantBeReadHasALine()
        {
            for (int load = 0; load < 2; ++load)
            {
                string file = _folder.Root + $"/none{load}.dcd";
                _player.TrajectorySource.SetFile(file);
                LogAssert.Expect(LogType.Error, new Regex("^quiet: trajectory: .*" + Regex.Escape(file)));
                _player.Load();
                TickUntil(() => _player.LastError.Message.Contains(file));
            }
        }

        private void TickUntil(Func<bool> condition)
        {
            Stopwatch waited = Stopwatch.StartNew();
            while (!condition())
            {
                Assert.That(waited.Elapsed.TotalSeconds, Is.LessThan(SurfaceRig.Patience), "still waiting");
                _player.Tick(0);
                Thread.Yield();
            }
        }
    }
}
