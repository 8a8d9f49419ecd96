// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.EngineDouble.Tests
{
    public sealed class ReloadTest
    {
        [Serializable]
        private sealed class Plain
        {
            public int Number;
        }

        [ExecuteAlways]
        private sealed class Keeper : MonoBehaviour
        {
            public int Public = 1;
            public string Text = null;
            public Vector3 Vector;
            public Mesh Mesh;
            public Action Callback;
            [NonSerialized] public int Forgotten = 2;
            public readonly List<int> ReadOnly = new List<int>();
            private Dictionary<int, int> _table;
            private int _private = 3;
            private Plain _plain;
            private IntPtr _pointer;
            public int Enables, Awakes;

            public void Change(Mesh mesh)
            {
                (Public, Vector, Forgotten, _private, _pointer) = (11, Vector3.one, 12, 13, new IntPtr(14));
                Mesh = mesh;
                _table = new Dictionary<int, int>();
                _plain = new Plain { Number = 15 };
                Callback = OnEnable;
                ReadOnly.Add(16);
            }

            public (int, int, IntPtr, bool) Hidden => (_private, _plain.Number, _pointer, _table == null);

            private void Awake() => ++Awakes;

            private void OnEnable() => ++Enables;
        }

        private static int s_initializations;

        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Initialize() => ++s_initializations;

        [Test]
        public void OnlyWhatCanBeSerializedSurvives()
        {
            Engine.EnterEditMode();
            var keeper = new GameObject().AddComponent<Keeper>();
            var mesh = new Mesh();
            keeper.Change(mesh);
            int callbacks = 0;
            Engine.BeforeReload += () => ++callbacks;
            Engine.Reload();
            Assert.That(callbacks, Is.EqualTo(1));
            Assert.That((keeper.Enables, keeper.Awakes), Is.EqualTo((2, 1)));
            Assert.That((keeper.Public, keeper.Vector, keeper.Text), Is.EqualTo((11, Vector3.one, "")));
            Assert.That(keeper.Mesh, Is.SameAs(mesh));
            Assert.That(keeper.Callback, Is.Null);
            Assert.That(keeper.Forgotten, Is.EqualTo(2));
            Assert.That(keeper.ReadOnly, Is.Empty);
            Assert.That(keeper.Hidden, Is.EqualTo((13, 15, IntPtr.Zero, true)));
            Assert.That(Engine.LiveObjects<Keeper>(), Is.EqualTo(1));
        }

        [Test]
        public void PlayModeWithoutReloadCallsInitializers()
        {
            Engine.EnterEditMode();
            var mesh = new Mesh { hideFlags = HideFlags.DontSave };
            var keeper = new GameObject().AddComponent<Keeper>();
            s_initializations = 0;
            Engine.EnterPlayModeWithoutReload(typeof(ReloadTest).Assembly);
            Assert.That(s_initializations, Is.EqualTo(1));
            Assert.That(Application.isPlaying, Is.True);
            Assert.That(keeper == null, Is.True);
            Assert.That(mesh != null, Is.True);
        }
    }
}
