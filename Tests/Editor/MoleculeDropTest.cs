// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using UnityEditor;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace QuickSes.Tests
{
    /// <summary>Where in the Hierarchy what is dropped goes.</summary>
    public sealed class MoleculeDropTest
    {
        private const HierarchyDropFlags Between = HierarchyDropFlags.DropBetween;

        private readonly CreatedSurfaces _created = new CreatedSurfaces();
        private GameObject _parent, _child;

        [SetUp]
        public void MakeObjects()
        {
            _parent = new GameObject("parent");
            _created.Keep(_parent.transform);
            _child = new GameObject("child");
            _child.transform.SetParent(_parent.transform);
        }

        [TearDown]
        public void Destroy() => _created.Destroy();

        [Test]
        public void UponAnObjectItIsTheParent() =>
            Assert.That(ParentFor(_child, HierarchyDropFlags.DropUpon, null), Is.SameAs(_child));

        [TestCase(Between)]
        [TestCase(Between | HierarchyDropFlags.DropAbove)]
        [TestCase(Between | HierarchyDropFlags.DropAbove | HierarchyDropFlags.DropAfterParent)]
        public void BetweenObjectsItIsTheirSibling(HierarchyDropFlags flags)
        {
            Assert.That(ParentFor(_child, flags, null), Is.SameAs(_parent));
            Assert.That(ParentFor(_parent, flags, null) == null, Is.True);
        }

        [Test]
        public void TheWindowMayNameTheParent() =>
            Assert.That(ParentFor(null, HierarchyDropFlags.None, _parent.transform), Is.SameAs(_parent));

        [Test]
        public void UponASceneItIsARootOfIt()
        {
            Scene active = SceneManager.GetActiveScene();
            MoleculeDrop.FindPlace(null, active.handle.ToString(), HierarchyDropFlags.DropUpon, null,
                out GameObject parent, out Scene scene);
            Assert.That(parent == null, Is.True);
            Assert.That(scene, Is.EqualTo(active));
        }

        private static GameObject ParentFor(GameObject target, HierarchyDropFlags flags, Transform named)
        {
            MoleculeDrop.FindPlace(target, "0", flags, named, out GameObject parent, out Scene scene);
            if (target != null)
                Assert.That(scene, Is.EqualTo(target.scene));
            return parent;
        }
    }
}
