// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble.Tests
{
    public sealed class LifecycleTest
    {
        private class Recorder : MonoBehaviour
        {
            public static readonly List<string> Calls = new List<string>();
            public static bool AreNamed;

            private void Awake() => Note("Awake");
            private void OnEnable() => Note("OnEnable");
            private void Reset() => Note("Reset");
            private void Start() => Note("Start");
            private void Update() => Note("Update");
            private void OnDidApplyAnimationProperties() => Note("OnDidApplyAnimationProperties");
            private void LateUpdate() => Note("LateUpdate");
            private void OnDisable() => Note("OnDisable");
            private void OnDestroy() => Note("OnDestroy");
            private void OnApplicationQuit() => Note("OnApplicationQuit");

            private void Note(string message) => Calls.Add(AreNamed ? $"{message} of {GetType().Name}" : message);
        }

        [ExecuteAlways]
        private sealed class EditRecorder : Recorder
        {
        }

        private sealed class Animated : MonoBehaviour
        {
            public float Place = 0;
            [SerializeField] private float _hidden = 0;
            private float _notSerialised = 0;

            public float Hidden => _hidden + _notSerialised;
            public double Told { get; private set; } = -1;

            private void OnDidApplyAnimationProperties() => Told = Place;
        }

        private sealed class Counter : MonoBehaviour
        {
            public int Updates;

            private void Update() => ++Updates;
        }

        private sealed class Thrower : MonoBehaviour
        {
            private void Update() => throw new InvalidOperationException("thrown by Update");
        }

        [RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
        [DisallowMultipleComponent]
        private sealed class Demanding : MonoBehaviour
        {
        }

        private static string[] Taken()
        {
            string[] calls = Recorder.Calls.ToArray();
            Recorder.Calls.Clear();
            return calls;
        }

        [SetUp]
        public void Forget()
        {
            Recorder.Calls.Clear();
            Recorder.AreNamed = false;
        }

        [Test]
        public void MessagesComeInOrder()
        {
            var recorder = new GameObject().AddComponent<Recorder>();
            Assert.That(Taken(), Is.EqualTo(new[] { "Awake", "OnEnable" }));
            Engine.Frame(0.1);
            Assert.That(Taken(), Is.EqualTo(new[] { "Start", "Update", "LateUpdate" }));
            recorder.enabled = false;
            Engine.Frame(0.1);
            recorder.enabled = true;
            Engine.Frame(0.1);
            Assert.That(Taken(), Is.EqualTo(new[] { "OnDisable", "OnEnable", "Update", "LateUpdate" }));
            recorder.gameObject.SetActive(false);
            Object.Destroy(recorder);
            Engine.Frame(0.1);
            Assert.That(Taken(), Is.EqualTo(new[] { "OnDisable", "OnDestroy" }));
        }

        [DefaultExecutionOrder(7)]
        private sealed class Late : Recorder
        {
        }

        [DefaultExecutionOrder(-7)]
        private sealed class Early : Recorder
        {
        }

        [Test]
        public void WhatHasALaterOrderIsToldLater()
        {
            var gameObject = new GameObject();
            foreach (Type type in new[] { typeof(Late), typeof(Early), typeof(Recorder) })
                gameObject.AddComponent(type);
            Taken();
            Recorder.AreNamed = true;
            Engine.Frame(0.1);
            string[] inOrder = { "Early", "Recorder", "Late" };
            Assert.That(Taken(), Is.EqualTo(new[] { "Start", "Update", "LateUpdate" }
                .SelectMany(message => inOrder.Select(name => $"{message} of {name}"))));
            Object.Instantiate(gameObject);
            Assert.That(Taken(), Is.EqualTo(
                inOrder.SelectMany(name => new[] { $"Awake of {name}", $"OnEnable of {name}" })));
        }

        [Test]
        public void AnimationsWriteBetweenUpdateAndLateUpdate()
        {
            var recorder = new GameObject().AddComponent<Recorder>();
            var animated = recorder.gameObject.AddComponent<Animated>();
            Engine.Frame(0.1);
            Taken();
            Engine.Animating += () => Recorder.Calls.Add("animation");
            Engine.Frame(0.1);
            Assert.That(Taken(), Is.EqualTo(new[] { "Update", "animation", "LateUpdate" }));
            Engine.Animate(animated, "Place", 3);
            Assert.That(animated.Told, Is.EqualTo(3));
            Engine.Animate(animated, "_hidden", 4);
            Assert.That(animated.Hidden, Is.EqualTo(4));
            animated.enabled = false;
            Engine.Animate(animated, "Place", 5);
            Assert.That(animated.Place, Is.EqualTo(5));
            Assert.That(animated.Told, Is.EqualTo(3));
            Assert.That(() => Engine.Animate(animated, "_notSerialised", 1), Throws.ArgumentException);
            Assert.That(() => Engine.Animate(animated, "none", 1), Throws.ArgumentException);
        }

        [Test]
        public void WhatWasNeverActiveIsNeverTold()
        {
            var gameObject = new GameObject();
            gameObject.SetActive(false);
            gameObject.AddComponent<Recorder>();
            Engine.Frame(0.1);
            Object.DestroyImmediate(gameObject);
            Assert.That(Taken(), Is.Empty);
        }

        [Test]
        public void ParentsSwitchTheirChildren()
        {
            var parent = new GameObject();
            var child = new GameObject();
            child.transform.SetParent(parent.transform);
            child.AddComponent<Recorder>();
            Taken();
            parent.SetActive(false);
            Assert.That(child.activeSelf, Is.True);
            Assert.That(child.activeInHierarchy, Is.False);
            Assert.That(Taken(), Is.EqualTo(new[] { "OnDisable" }));
            Object.DestroyImmediate(parent);
            Assert.That(child == null, Is.True);
            Assert.That(Taken(), Is.EqualTo(new[] { "OnDestroy" }));
        }

        [Test]
        public void EditModeRunsWhatAsksForIt()
        {
            Engine.EnterEditMode();
            var gameObject = new GameObject();
            gameObject.AddComponent<Recorder>();
            Engine.Frame(0.1);
            Assert.That(Taken(), Is.EqualTo(new[] { "Reset" }));
            gameObject.AddComponent<EditRecorder>();
            Engine.Frame(0.1);
            Assert.That(Taken(), Is.EqualTo(new[] { "Awake", "OnEnable", "Reset", "Start", "Update", "LateUpdate" }));
            LogAssert.Expect(LogType.Error, new Regex("^Destroy may not be called from edit mode"));
            Object.Destroy(gameObject);
            Engine.Frame(0.1);
            Assert.That(gameObject == null, Is.False);
        }

        [Test]
        public void PlayModeInTheSceneOfEditModeWakesOnlyWhatDidNotRunThere()
        {
            Engine.EnterEditMode();
            var ofEditMode = new GameObject().AddComponent<EditRecorder>();
            Engine.Frame(0.1);
            Taken();
            Engine.EnterPlayModeInTheSameScene();
            Assert.That(Application.isPlaying, Is.True);
            Assert.That(ofEditMode != null);
            Engine.Frame(0.1);
            Assert.That(Taken(), Is.EqualTo(new[] { "OnDisable", "OnEnable", "Start", "Update", "LateUpdate" }));

            Engine.EnterEditMode();
            new GameObject().AddComponent<Recorder>();
            Taken();
            Engine.EnterPlayModeInTheSameScene();
            Assert.That(Taken(), Is.EqualTo(new[] { "Awake", "OnEnable" }));
        }

        [Test]
        public void QuittingTellsAll()
        {
            new GameObject().AddComponent<Recorder>();
            Taken();
            void Note() => Recorder.Calls.Add("quitting");
            Application.quitting += Note;
            Engine.Quit();
            Application.quitting -= Note;
            Assert.That(Taken(), Is.EqualTo(new[] { "OnApplicationQuit", "quitting", "OnDisable", "OnDestroy" }));
        }

        [Test]
        public void DestroyedObjectsEqualNull()
        {
            var gameObject = new GameObject("one");
            var counter = gameObject.AddComponent<Counter>();
            Object.Destroy(counter);
            Assert.That(counter == null, Is.False, "destroyed at the end of the frame only");
            Engine.Frame(0.1);
            Assert.That(counter == null, Is.True);
            Assert.That(ReferenceEquals(counter, null), Is.False);
            Assert.That(counter.Updates, Is.EqualTo(1));
            Assert.That(() => counter.transform, Throws.TypeOf<MissingReferenceException>());
            Assert.That(() => counter.enabled, Throws.TypeOf<MissingReferenceException>());
            Assert.That(gameObject.GetComponent<Counter>(), Is.Null);
        }

        [Test]
        public void RequirementsAreMet()
        {
            var gameObject = new GameObject();
            gameObject.AddComponent<Demanding>();
            Assert.That(gameObject.TryGetComponent(out MeshFilter filter), Is.True);
            Assert.That(gameObject.GetComponent<MeshRenderer>() != null);
            LogAssert.Expect(LogType.Error, new Regex("^Can't add component 'Demanding'"));
            Assert.That(gameObject.AddComponent<Demanding>(), Is.Null);
            LogAssert.Expect(LogType.Error, new Regex("^Can't remove MeshFilter"));
            Object.DestroyImmediate(filter);
            Assert.That(filter != null, Is.True);
        }

        [Test]
        public void ExceptionsGoToTheLog()
        {
            var gameObject = new GameObject();
            gameObject.AddComponent<Thrower>();
            var counter = gameObject.AddComponent<Counter>();
            LogAssert.Expect(LogType.Exception, new Regex("thrown by Update"));
            Engine.Frame(0.1);
            Assert.That(counter.Updates, Is.EqualTo(1));
            Object.DestroyImmediate(gameObject);
        }

        [Test]
        public void FramesAllocateNothing()
        {
            var counter = new GameObject().AddComponent<Counter>();
            Engine.Frame(0.1);
            Assert.That(() =>
            {
                for (int i = 0; i < 100; ++i)
                    Engine.Frame(0.1);
            }, Is.Not.AllocatingGCMemory());
            Assert.That(counter.Updates, Is.EqualTo(101));
        }

        [Test]
        public void OtherThreadsAreRefused()
        {
            var gameObject = new GameObject();
            Exception error = null;
            var thread = new System.Threading.Thread(() =>
            {
                try
                {
                    gameObject.SetActive(false);
                }
                catch (Exception exception)
                {
                    error = exception;
                }
            });
            thread.Start();
            thread.Join();
            Assert.That(error, Is.TypeOf<UnityException>().With.Message.Contains("main thread"));
        }
    }
}
