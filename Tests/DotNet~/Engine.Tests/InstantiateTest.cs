// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble.Tests
{
    public sealed class InstantiateTest
    {
        [Serializable]
        private abstract class Base
        {
            [SerializeField] private int _inherited = 1;

            public int Inherited { get => _inherited; set => _inherited = value; }
        }

        [Serializable]
        private sealed class Part : Base
        {
            public float[] Numbers = { 1 };
            public Transform Place;
            [NonSerialized] public int Forgotten = 2;
        }

        private class Script : MonoBehaviour
        {
            [SerializeField] private int _inBase = 3;

            public int InBase { get => _inBase; set => _inBase = value; }
        }

        private sealed class Copied : Script
        {
            public int Number = 4;
            public string Text = null;
            public Part Part = new Part();
            public List<Part> Parts = new List<Part>();
            public GameObject Inside, Outside;
            public Component[] Several;
            public Mesh Mesh;
            public Action Callback;
            [NonSerialized] public int Forgotten = 5;
            [SerializeField] private Vector3 _serialized;
            private int _private = 6;

            public readonly List<string> Calls = new List<string>();

            public (Vector3, int) Hidden
            {
                get => (_serialized, _private);
                set => (_serialized, _private) = value;
            }

            private void Awake() => Calls.Add("Awake " + Number);

            private void OnEnable() => Calls.Add("OnEnable " + (Inside == null ? "" : Inside.name));
        }

        private sealed class Suicidal : MonoBehaviour
        {
            public bool IsCopy;

            private void Awake()
            {
                if (IsCopy)
                    Object.DestroyImmediate(gameObject);
            }
        }

        private GameObject _original, _child;
        private Copied _script;

        [SetUp]
        public void SetUp()
        {
            _original = new GameObject("original", typeof(Copied), typeof(MeshFilter), typeof(MeshRenderer))
            {
                tag = "Player"
            };
            _child = new GameObject("child", typeof(MeshFilter));
            _child.transform.SetParent(_original.transform, false);
            _original.transform.localPosition = new Vector3(1, 2, 3);
            _child.transform.localScale = new Vector3(2, 2, 2);
            _script = _original.GetComponent<Copied>();
        }

        [Test]
        public void TheHierarchyIsCopied()
        {
            GameObject copy = Object.Instantiate(_original);
            Assert.That(copy, Is.Not.SameAs(_original));
            Assert.That((copy.name, copy.tag), Is.EqualTo(("original(Clone)", "Player")));
            foreach (Type type in new[] { typeof(Copied), typeof(MeshFilter), typeof(MeshRenderer) })
                Assert.That(copy.GetComponent(type) != null);
            Assert.That(copy.transform.localPosition, Is.EqualTo(new Vector3(1, 2, 3)));
            Assert.That(copy.transform.parent == null);
            Assert.That(copy.transform.childCount, Is.EqualTo(1));
            Transform child = copy.transform.GetChild(0);
            Assert.That(child, Is.Not.SameAs(_child.transform));
            Assert.That((child.name, child.localScale), Is.EqualTo(("child", new Vector3(2, 2, 2))));
            Assert.That(_original.transform.childCount, Is.EqualTo(1));
            Object.DestroyImmediate(copy);
            Assert.That(_child != null);
        }

        [Test]
        public void SerializedFieldsAreCopiedAndOthersAreAsNew()
        {
            var part = new Part { Inherited = 11, Numbers = new[] { 12f, 13 }, Forgotten = 14 };
            (_script.Number, _script.InBase, _script.Forgotten) = (15, 16, 17);
            _script.Hidden = (Vector3.one, 18);
            _script.Part = part;
            _script.Parts.Add(part);
            _script.Callback = SetUp;
            Copied copy = Object.Instantiate(_script);
            Assert.That(copy, Is.Not.SameAs(_script));
            Assert.That((copy.Number, copy.InBase, copy.Forgotten, copy.Text), Is.EqualTo((15, 16, 5, "")));
            Assert.That(copy.Hidden, Is.EqualTo((Vector3.one, 6)));
            Assert.That(copy.Callback, Is.Null);
            Assert.That(copy.Parts, Has.Count.EqualTo(1));
            Assert.That(copy.Part, Is.Not.SameAs(copy.Parts[0]), "two fields are two objects");
            foreach (Part copied in new[] { copy.Part, copy.Parts[0] })
            {
                Assert.That(copied, Is.Not.SameAs(part));
                Assert.That((copied.Inherited, copied.Forgotten), Is.EqualTo((11, 2)));
                Assert.That(copied.Numbers, Is.EqualTo(part.Numbers).And.Not.SameAs(part.Numbers));
            }
        }

        [Test]
        public void ReferencesIntoTheHierarchyAreThoseOfTheCopy()
        {
            var other = new GameObject("other");
            var mesh = new Mesh();
            _child.GetComponent<MeshFilter>().sharedMesh = mesh;
            (_script.Inside, _script.Outside, _script.Mesh) = (_child, other, mesh);
            _script.Several = new Component[] { _script, _child.transform, other.transform, null };
            _script.Part.Place = _child.transform;
            Copied copy = Object.Instantiate(_script);
            Transform child = copy.transform.GetChild(0);
            Assert.That(copy.Inside, Is.SameAs(child.gameObject));
            Assert.That(copy.Outside, Is.SameAs(other));
            Assert.That(copy.Mesh, Is.SameAs(mesh));
            Assert.That(copy.Several, Is.EqualTo(new Component[] { copy, child, other.transform, null }));
            Assert.That(copy.Part.Place, Is.SameAs(child));
            Assert.That(child.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(mesh), "assets are shared");
        }

        [Test]
        public void ScriptsWakeWhenEverythingIsThere()
        {
            _script.Number = 21;
            _script.Inside = _child;
            Copied copy = Object.Instantiate(_script);
            Assert.That(copy.Calls, Is.EqualTo(new[] { "Awake 21", "OnEnable child" }));
            _script.enabled = false;
            Assert.That(Object.Instantiate(_script).Calls, Is.EqualTo(new[] { "Awake 21" }));
            _original.SetActive(false);
            copy = Object.Instantiate(_script);
            Assert.That(copy.Calls, Is.Empty);
            copy.gameObject.SetActive(true);
            Assert.That(copy.Calls, Is.EqualTo(new[] { "Awake 21" }), "it is not enabled");
        }

        [Test]
        public void WhatCantBeCopiedThrows()
        {
            Assert.Throws<ArgumentException>(() => Object.Instantiate<GameObject>(null));
            Object.DestroyImmediate(_original);
            Assert.Throws<ArgumentException>(() => Object.Instantiate(_original));
            Assert.Throws<NotSupportedException>(() => Object.Instantiate(new Mesh()));
            var suicidal = new GameObject().AddComponent<Suicidal>();
            suicidal.IsCopy = true;
            Assert.Throws<UnityException>(() => Object.Instantiate(suicidal));
        }
    }
}
