// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.Reflection;
using UnityEngine;
using UnityEditorInspector = UnityEditor.Editor;

namespace QuickSes.Tests
{
    public sealed class MolecularSurfaceEditorTest
    {
        private readonly CreatedSurfaces _created = new CreatedSurfaces();
        private MolecularSurface _surface;

        [SetUp]
        public void MakeSurface()
        {
            _surface = _created.MakeComputed();
        }

        [TearDown]
        public void Destroy() => _created.Destroy();

        [Test]
        public void TheInspectorRepaintsWhileItIsBusyAndOnceMore()
        {
            UnityEditorInspector inspector = UnityEditorInspector.CreateEditor(_surface);
            try
            {
                Assert.That(inspector, Is.InstanceOf<MolecularSurfaceEditor>());
                Assert.That(inspector.RequiresConstantRepaint(), Is.False);
                _surface.Recompute();
                Assert.That(inspector.RequiresConstantRepaint(), Is.True);
                _surface.Cancel();
                Assert.That(inspector.RequiresConstantRepaint(), Is.True);
                Assert.That(inspector.RequiresConstantRepaint(), Is.False);
            }
            finally
            {
                Object.DestroyImmediate(inspector);
            }
        }

        [Test]
        public void WhatNamesAtomsIsClosedWithTheInspector([Values] bool isWanted)
        {
            _surface.Source.SetAsset(new TextAsset(
                "ATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\nEND\n") { name = "one.pdb" });
            Assert.That(_surface.LoadSource(), Is.True, _surface.LastError.ToString());
            UnityEditorInspector inspector = UnityEditorInspector.CreateEditor(_surface);
            object underMouse = Get(inspector, "_atomUnderMouse").GetValue(inspector);
            Get(underMouse, "_isWanted").SetValue(underMouse, isWanted);
            Structure structure = _surface.Structure;
            Object.DestroyImmediate(inspector);
            Assert.That(structure.IsDisposed, Is.EqualTo(isWanted), "another may have opened it");
        }

        private static FieldInfo Get(object owner, string field) =>
            owner.GetType().GetField(field, BindingFlags.Instance | BindingFlags.NonPublic);
    }
}
