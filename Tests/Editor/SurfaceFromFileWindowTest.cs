// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using UnityEditor;

namespace QuickSes.Tests
{
    public sealed class SurfaceFromFileWindowTest
    {
        [Test]
        public void TheWindowOpens()
        {
            Assert.That(EditorApplication.ExecuteMenuItem(MolecularMenu.FromFile), Is.True);
            Assert.That(EditorWindow.HasOpenInstances<SurfaceFromFileWindow>(), Is.True);
            EditorWindow.GetWindow<SurfaceFromFileWindow>().Close();
        }
    }
}
