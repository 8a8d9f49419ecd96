// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using UnityEditor;
using UnityEngine;

namespace QuickSes.EngineDouble.Tests
{
    [EditorTest]
    public sealed class EditingTest
    {
        private enum Kind
        {
            First,
            Second
        }

        [Serializable]
        private sealed class Part
        {
            [SerializeField] private Kind _kind = Kind.First;

            public Kind Kind => _kind;
        }

        [ExecuteAlways]
        private sealed class Script : MonoBehaviour
        {
            [SerializeField] private Part _part = new Part();
            [SerializeField] private float _number = 1;
            [SerializeField] private UnityEngine.Object _other = null;

            public (Kind, float, UnityEngine.Object) Values => (_part.Kind, _number, _other);

            public int Validations { get; private set; }

            public int Updates { get; private set; }

            private void OnValidate() => ++Validations;

            private void LateUpdate() => ++Updates;
        }

        [Test]
        public void EditsAreOneStepOfUndo()
        {
            var script = new GameObject("script").AddComponent<Script>();
            int before = script.Validations;
            var edited = new SerializedObject(script);
            edited.FindProperty("_part").FindPropertyRelative("_kind").intValue = (int)Kind.Second;
            edited.FindProperty("_number").floatValue += 2;
            edited.FindProperty("_other").objectReferenceValue = script.gameObject;
            Assert.That(script.Values, Is.EqualTo((Kind.First, 1f, (UnityEngine.Object)null)));
            Assert.That(edited.ApplyModifiedProperties(), Is.True);
            Assert.That(script.Values, Is.EqualTo((Kind.Second, 3f, (UnityEngine.Object)script.gameObject)));
            Assert.That(script.Validations, Is.EqualTo(before + 1));
            Assert.That(edited.ApplyModifiedProperties(), Is.False);
            Undo.PerformUndo();
            Assert.That(script.Values, Is.EqualTo((Kind.First, 1f, (UnityEngine.Object)null)));
            Assert.That(script.Validations, Is.EqualTo(before + 2));
            Assert.That(() => edited.FindProperty("none"), Throws.ArgumentException);
        }

        [Test]
        public void UndoTakesBackAStepTheLastFirst()
        {
            var first = new GameObject("first", typeof(MeshRenderer));
            Undo.RegisterCreatedObjectUndo(first, "Create");
            Undo.IncrementCurrentGroup();
            var renderer = first.GetComponent<MeshRenderer>();
            Undo.RecordObject(renderer, "Change");
            renderer.sharedMaterial = new Material();
            var added = Undo.AddComponent<Script>(first);
            Undo.PerformUndo();
            Assert.That(added == null && renderer.sharedMaterial == null && first != null, Is.True);
            Undo.PerformUndo();
            Assert.That(first == null, Is.True);
            Undo.PerformUndo(); // there is nothing
        }

        [Test]
        public void InEditModeScriptsRunWhenSomebodyAsks()
        {
            var script = new GameObject("script").AddComponent<Script>();
            Engine.Frame();
            Engine.Frame();
            int before = script.Updates;
            Engine.Frame();
            Assert.That(script.Updates, Is.EqualTo(before));
            EditorApplication.QueuePlayerLoopUpdate();
            Engine.Frame();
            Engine.Frame();
            Assert.That(script.Updates, Is.EqualTo(before + 1));
            Engine.EnterPlayModeInTheSameScene();
            Engine.Frame();
            Engine.Frame();
            Assert.That(script.Updates, Is.EqualTo(before + 3));
        }

        [Test]
        public void DelayedCallsComeOnce()
        {
            int calls = 0;
            EditorApplication.delayCall += () => ++calls;
            Assert.That(calls, Is.Zero);
            Engine.Frame();
            Engine.Frame();
            Assert.That(calls, Is.EqualTo(1));
        }

        [Test]
        public void NewSiblingsHaveNamesOfTheirOwn()
        {
            var first = new GameObject("name");
            var second = new GameObject("name");
            GameObjectUtility.EnsureUniqueNameForSibling(second);
            Assert.That(second.name, Is.EqualTo("name (1)"));
            GameObjectUtility.SetParentAndAlign(first, second);
            GameObjectUtility.EnsureUniqueNameForSibling(first);
            Assert.That(first.name, Is.EqualTo("name"));
        }
    }
}
