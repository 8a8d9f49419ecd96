// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
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
    }
}
