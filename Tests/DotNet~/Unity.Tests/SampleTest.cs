// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using QuickSes.Samples;
using System;
using System.Collections;
using System.IO;
using System.Reflection;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>
    /// The sample's scripts, wired as its scene wires them (what the scene's file says is proved by check-references).
    /// </summary>
    internal sealed class SampleTest
    {
        private MolecularSurface _surface;
        private TrajectoryPlayer _player;
        private Camera _camera;

        [SetUp]
        public void MakeScene()
        {
            _camera = new GameObject("camera").AddComponent<Camera>();
            var orbit = _camera.gameObject.AddComponent<OrbitCamera>();
            var molecule = new GameObject("molecule");
            molecule.SetActive(false);
            _surface = molecule.AddComponent<MolecularSurface>();
            _player = molecule.AddComponent<TrajectoryPlayer>();
            _player.StructureSource.SetFile(
                Path.Combine(Repository.Root, "Samples~", "TrajectoryPlayback", "2k39_ensemble.pdb.gz.bytes"));
            var panel = molecule.AddComponent<TrajectoryPlaybackUI>();
            Wire(panel, "_surface", _surface);
            Wire(panel, "_player", _player);
            Wire(panel, "_orbit", orbit);
            molecule.SetActive(true);
        }

        [UnityTest]
        public IEnumerator TheEnsemblePlaysInView()
        {
            yield return SurfaceRig.Until(() => _player.IsReady && _surface.CurrentLevel.LevelCount > 0);
            Assert.That(_player.FrameCount, Is.EqualTo(116));
            for (int k = 0; k < 2; ++k)
            {
                int before = _player.ShownFrame;
                yield return SurfaceRig.Until(() => _player.ShownFrame != before);
            }
            Engine.Gui();
            yield return null;
            Vector3 centre = _surface.transform.TransformPoint(_surface.Mesh.bounds.center);
            Vector3 ahead = (centre - _camera.transform.position).normalized;
            Assert.That(Vector3.Dot(ahead, _camera.transform.forward), Is.GreaterThan(0.99), "the camera looks at it");
        }

        [UnityTest]
        public IEnumerator TheModelThatIsShownIsNamedOnTheWayBackToo()
        {
            yield return SurfaceRig.Until(() => _player.ShownFrame >= 0);
            _player.Pause();
            _player.FramesPerSecond = -1;
            yield return null;
            _player.Frame = 3.2;
            yield return SurfaceRig.Until(() => _player.ShownFrame == 4);
            Assert.That(Engine.Gui(), Has.Member("Model 5 of 116"));
        }

        [UnityTest]
        public IEnumerator TheMouseTurnsTheCamera()
        {
            yield return SurfaceRig.Until(() => _surface.CurrentLevel.LevelCount > 0);
            yield return null;
            Vector3 before = _camera.transform.position;
            float distance = (before - Centre()).magnitude;
            Send(EventType.MouseDrag, new Vector2(300, 0));
            yield return null;
            Assert.That((_camera.transform.position - before).magnitude, Is.GreaterThan(0.5f * distance));
            Send(EventType.ScrollWheel, new Vector2(0, -10));
            yield return null;
            Assert.That((_camera.transform.position - Centre()).magnitude, Is.LessThan(0.9f * distance));
        }

        private Vector3 Centre() => _surface.transform.TransformPoint(_surface.Mesh.bounds.center);

        private void Send(EventType type, Vector2 delta)
        {
            Event.current = new Event { type = type, delta = delta, mousePosition = new Vector2(1500, 800) };
            _camera.GetComponent<OrbitCamera>().Handle(Event.current);
            Event.current = null;
        }

        private static void Wire(MonoBehaviour script, string field, object value)
        {
            FieldInfo info = script.GetType().GetField(field, BindingFlags.Instance | BindingFlags.NonPublic);
            Assert.That(info != null && info.IsDefined(typeof(SerializeField), false), field);
            info.SetValue(script, value);
        }
    }
}
