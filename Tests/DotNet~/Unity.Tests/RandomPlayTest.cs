// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>
    /// Whatever is done to some players and surfaces in whatever order: what a player says it shows, its surfaces have, and
    /// in the end each plays as if nothing had been. What a step does is a matter of the seed alone; when files are read
    /// is not.
    /// </summary>
    internal sealed class RandomPlayTest
    {
        private const int Players = 3, Others = 2, Steps = 700;
        private const int FramesApart = 40; // of one file and the next, in frames of TestFrames

        /// <summary>A structure, and where its frames are.</summary>
        private sealed class Film
        {
            public string Structure, Trajectory = "", Damaged = "";
            public int Number, FrameCount;

            public List<Vector3[]> Frames =>
                TestFrames.Frames((Number + 1) * FramesApart).GetRange(Number * FramesApart, FrameCount);
        }

        private readonly SurfaceRig[] _others = new SurfaceRig[Others];
        private readonly SurfaceRig[] _rigs = new SurfaceRig[Players];
        private readonly TrajectoryPlayer[] _players = new TrajectoryPlayer[Players];
        private readonly Film[] _set = new Film[Players], _ofSurface = new Film[Players]; // null: none
        private readonly HashSet<int>[] _maybe = new HashSet<int>[Players]; // numbers of films that may be loaded
        private readonly List<Film> _films = new List<Film>();
        private readonly List<string> _done = new List<string>();
        private TestFolder _folder;
        private int _seed, _calls, _actsOfHandlers, _actsBefore, _lastFrame = -1;
        private bool _isOver;

        [SetUp]
        public void WriteFiles()
        {
            _folder = new TestFolder();
            _films.Clear();
            for (int number = 0; number < 6; ++number)
            {
                var film = new Film { Number = number, FrameCount = 2 + 5 * number };
                bool isEnsemble = number % 2 == 0;
                film.Structure = _folder.Write($"{number}.pdb",
                    TestFrames.Pdb(isEnsemble ? film.Frames : film.Frames.GetRange(0, 1)));
                byte[] dcd = TestFrames.Dcd(film.Frames);
                if (!isEnsemble)
                    film.Trajectory = _folder.Write($"{number}.dcd", dcd);
                film.Damaged = _folder.Write($"damaged {number}.dcd", dcd.AsSpan(0, dcd.Length / 3).ToArray());
                _films.Add(film);
            }
        }

        [TearDown]
        public void TellWhatWasDone()
        {
            if (TestContext.CurrentContext.Result.Outcome.Status == NUnit.Framework.Interfaces.TestStatus.Failed)
                TestContext.Out.WriteLine(string.Join("\n", _done));
            _folder.Dispose();
        }

        [UnityTest]
        public IEnumerator EachPlaysItsOwnInTheEnd([Values(1, 2, 3, 4)] int seed)
        {
            _seed = seed;
            _calls = _actsOfHandlers = 0;
            _isOver = false;
            _done.Clear();
            bool isEditMode = seed % 2 == 0; // until the end
            if (isEditMode)
                Engine.EnterEditMode();
            for (int k = 0; k < Others; ++k)
                _others[k] = new SurfaceRig("other " + k);
            for (int k = 0; k < Players; ++k)
                Renew(k);
            for (int step = 1; step <= Steps; ++step)
            {
                System.Random random = RandomOf(step);
                DoSomething(random.Next(Players), random, $"step {step}");
                if (random.Next(3) > 0)
                    Engine.Frame(new[] { 0, 0.004, 0.1, 1, 1000 }[random.Next(5)]);
                if (random.Next(8) == 0)
                    yield return SurfaceRig.Until(() => !Array.Exists(_players, player => player.IsLoading));
                foreach (TrajectoryPlayer player in _players)
                    AssertIsSensible(player);
            }
            _isOver = true;
            if (isEditMode)
                Engine.EnterPlayModeInTheSameScene(typeof(MolecularSurface).Assembly);
            for (int k = 0; k < Players; ++k)
                _players[k].Unload();
            for (int k = 0; k < Players; ++k)
                yield return PlayToTheEnd(k);
            for (int k = 0; k < Players; ++k)
                _rigs[k].Dispose();
            foreach (SurfaceRig other in _others)
                other.Dispose();
        }

        private void Renew(int k)
        {
            _rigs[k] = new SurfaceRig("played " + k);
            _set[k] = _ofSurface[k] = null;
            _maybe[k] = new HashSet<int>();
            TrajectoryPlayer player = _players[k] = _rigs[k].GameObject.AddComponent<TrajectoryPlayer>();
            player.FrameShown += frame => AssertShows(k, player, frame);
            player.FrameShown += _ => Answer(k);
            player.Loaded += () => Answer(k);
            player.Looped += () => Answer(k);
            player.Finished += () => Answer(k);
            player.Failed += (frame, error) => Answer(k);
        }

        private System.Random RandomOf(int number) => TestMolecules.RandomOf(100000 * _seed + number);

        // Handlers may do anything, too.
        private void Answer(int k)
        {
            System.Random random = RandomOf(Steps + ++_calls);
            if (_isOver || random.Next(8) > 0)
                return;
            ++_actsOfHandlers;
            DoSomething(k, random, $"handler {_calls}");
        }

        private static void AssertIsSensible(TrajectoryPlayer player)
        {
            Assert.That(player.ShownFrame, Is.LessThan(Math.Max(1, player.FrameCount)));
            if (player.IsReady)
                Assert.That(player.Frame, Is.InRange(0, player.FrameCount - 1));
            Assert.That(player.NormalizedTime, Is.InRange(0, 1));
            Assert.That(player.LoadProgress, Is.InRange(0, 1));
            Assert.That(player.IsReady && player.IsLoading, Is.False);
        }

        // The frame of one film, and of one that was asked for: in its own surface and all others that it has. When a
        // handler acted before this one in the same frame of the game, others may have had something new since.
        private void AssertShows(int k, TrajectoryPlayer player, int frame)
        {
            Assert.That(player.ShownFrame, Is.EqualTo(frame));
            if (_lastFrame != Time.frameCount)
                _actsBefore = _actsOfHandlers;
            _lastFrame = Time.frameCount;
            if (_actsBefore != _actsOfHandlers)
                return;
            MolecularSurface own = _rigs[k].Surface;
            Assert.That(own.AtomCount, Is.EqualTo(TestFrames.WithoutWater.Length));
            double place = -own.Positions[0].x / 0.12; // of its first atom, as TestFrames.Position has it
            int number = (int)Math.Floor((place + 1e-3) / FramesApart);
            Assert.That(_maybe[k], Does.Contain(number));
            Assert.That(player.FrameCount, Is.AtMost(_films[number].FrameCount)); // files may be cut off
            place -= FramesApart * number;
            Assert.That(Math.Abs(place - frame), Is.LessThan((player.Interpolate ? 1 : 0) + 1e-3));
            AssertAt(own, FramesApart * number + place);
            foreach (SurfaceRig other in _others)
                if (other.Surface.Player == player && other.Surface.AtomCount == own.AtomCount)
                    AssertAt(other.Surface, FramesApart * number + place);
        }

        private static void AssertAt(MolecularSurface surface, double place)
        {
            int before = (int)Math.Floor(place + 1e-3);
            var weight = (float)(place - before);
            for (int i = 0; i < surface.AtomCount; ++i)
            {
                int atom = TestFrames.WithoutWater[i];
                Vector3 file = TestFrames.Position(before, atom);
                if (weight > 1e-3f)
                    file = (1 - weight) * file + weight * TestFrames.Position(before + 1, atom);
                Assert.That((surface.Positions[i] - new Vector3(-file.x, file.y, file.z)).magnitude, Is.LessThan(2e-3f));
            }
        }

        // Made anew from whatever it has become.
        private IEnumerator PlayToTheEnd(int k)
        {
            TrajectoryPlayer player = _players[k];
            Film film = _films[(k + _seed) % _films.Count];
            _rigs[k].GameObject.SetActive(true);
            player.enabled = _rigs[k].Surface.enabled = true;
            foreach (SurfaceRig other in _others)
                player.RemoveSurface(other.Surface);
            Choose(k, film, film.Trajectory);
            player.Interpolate = player.Unwrap = false;
            player.Mode = PlaybackMode.Once;
            player.FramesPerSecond = 50;
            player.Frame = 0;
            Assert.That(player.Load(), player.LastError.ToString());
            var shown = new List<int>();
            bool isFinished = false;
            player.FrameShown += frame => shown.Add(frame);
            player.Finished += () => isFinished = true;
            player.Play();
            yield return SurfaceRig.Until(() =>
            {
                Engine.Frame(0.01);
                return isFinished;
            });
            Assert.That(shown[0], Is.EqualTo(0));
            Assert.That(shown, Is.Ordered);
            Assert.That(shown[shown.Count - 1], Is.EqualTo(film.FrameCount - 1));
            Assert.That(player.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
            yield return _rigs[k].Settle();
            AssertAt(_rigs[k].Surface, FramesApart * film.Number + film.FrameCount - 1);
            Assert.That(_rigs[k].Surface.CurrentLevel.IsOfNewestAtoms);
        }

        private void Choose(int k, Film film, string trajectory)
        {
            _players[k].StructureSource.SetFile(film.Structure);
            if (trajectory.Length > 0)
                _players[k].TrajectorySource.SetFile(trajectory);
            else
                _players[k].TrajectorySource.Kind = MoleculeSourceKind.None;
            _set[k] = film;
            _maybe[k].Add(film.Number);
        }

        private void Load(int k)
        {
            ExpectWhatIsSet(k);
            _players[k].Load();
        }

        // Those of the player, or of its surface, which it plays where it has none of its own.
        private void ExpectWhatIsSet(int k)
        {
            _maybe[k].Clear();
            if ((_set[k] ?? _ofSurface[k]) is Film film)
                _maybe[k].Add(film.Number);
        }

        private void DoSomething(int k, System.Random random, string who)
        {
            TrajectoryPlayer player = _players[k];
            MolecularSurface surface = _rigs[k].Surface;
            Film film = _films[random.Next(_films.Count)];
            SurfaceRig other = _others[random.Next(Others)];
            int what = random.Next(26);
            _done.Add($"{who}: {what} of player {k}, which shows {player.ShownFrame} of {player.FrameCount} frames");
            switch (what)
            {
                case 0:
                case 1:
                case 2:
                case 3:
                    Choose(k, film, film.Trajectory);
                    Load(k);
                    break;
                case 4:
                    Choose(k, film, film.Damaged);
                    Load(k);
                    break;
                case 5:
                    Choose(k, film, film.Structure + "no such file");
                    Load(k);
                    break;
                case 6:
                    Choose(k, film, film.Trajectory); // and not loaded
                    break;
                case 7:
                case 8:
                case 9:
                    player.Play();
                    break;
                case 10:
                    if (random.Next(2) > 0)
                        player.Pause();
                    else
                        player.Stop();
                    break;
                case 11:
                    player.Frame = random.Next(5) switch
                    {
                        0 => double.NaN, 1 => -3, 2 => double.PositiveInfinity, _ => 10 * random.NextDouble()
                    };
                    break;
                case 12:
                    player.NormalizedTime = 1.2 * random.NextDouble();
                    break;
                case 13:
                    player.Mode = (PlaybackMode)random.Next(3);
                    break;
                case 14:
                    player.FramesPerSecond = new[] { 0, -7, 30, 1e30f, -1e-30f }[random.Next(5)];
                    break;
                case 15:
                    player.Interpolate = !player.Interpolate;
                    break;
                case 16:
                    player.Unwrap = random.Next(4) == 0;
                    player.PrefetchFrames = random.Next(20);
                    break;
                case 17:
                    if (random.Next(2) > 0)
                        player.Unload();
                    else
                        player.CancelLoading();
                    break;
                case 18:
                    ExpectWhatIsSet(k);
                    player.enabled = !player.enabled;
                    break;
                case 19:
                    ExpectWhatIsSet(k);
                    _rigs[k].GameObject.SetActive(!_rigs[k].GameObject.activeSelf);
                    break;
                case 20:
                    if (!player.RemoveSurface(other.Surface))
                        player.AddSurface(other.Surface);
                    break;
                case 21:
                    TestMolecules.Blob(6 + random.Next(20), random.Next(), out Vector3[] positions, out float[] radii);
                    surface.SetAtoms(positions, radii);
                    break;
                case 22:
                    switch (random.Next(4))
                    {
                        case 0:
                            surface.ClearAtoms();
                            break;
                        case 1:
                            surface.enabled = !surface.enabled;
                            break;
                        case 2:
                            surface.Cancel();
                            break;
                        case 3 when surface.AtomCount > 0:
                            surface.ComputeNow();
                            break;
                    }
                    break;
                case 23:
                    surface.Source.SetFile(film.Structure);
                    _ofSurface[k] = film;
                    _maybe[k].Add(film.Number);
                    player.FollowEdits();
                    break;
                case 24:
                    player.ColorScheme = (AtomColorScheme)random.Next(3);
                    break;
                case 25:
                    if (random.Next(3) > 0)
                        break;
                    _rigs[k].Dispose();
                    Renew(k);
                    break;
            }
        }
    }
}
