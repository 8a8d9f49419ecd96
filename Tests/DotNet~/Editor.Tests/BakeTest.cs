// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using QuickSes.EngineDouble;
using System;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.RegularExpressions;
using UnityEditor;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>What baking leaves in the project, in memory and in the scene, whatever the user or the disk do.</summary>
    public sealed class BakeTest
    {
        private const int MostFrames = 100000;
        private const string MeshPath = "Assets/a mesh.asset";
        private const string MaterialPath = "Assets/a material.mat";
        private const string PrefabPath = "Assets/a.prefab";

        private readonly IGpuLibrary _library = GpuDelivery.Library;
        private MolecularSurface _surface;
        private MeshRenderer _renderer;

        [SetUp]
        public void MakeSurface()
        {
            _surface = SurfaceCreator.CreateEmpty(null);
            _surface.name = "name";
            _renderer = _surface.GetComponent<MeshRenderer>();
            CreatedSurfaces.GiveAtoms(_surface);
        }

        [TearDown]
        public void OpenGate()
        {
            NativeGate.Open();
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            GpuDelivery.Library = _library;
        }

        [TestCase(MeshPath)]
        [TestCase(MaterialPath)]
        [TestCase(PrefabPath)]
        public void WhereVersionControlRefusesOneFileAllStayAsTheyAre(string locked)
        {
            UseMaterialOfItsOwn();
            Assert.That(TryBakePrefab(), Is.Empty);
            var mesh = AssetDatabase.LoadAssetAtPath<Mesh>(MeshPath);
            int vertices = mesh.vertexCount;
            EditorDriver.Lock(locked);
            _surface.Spacing /= 2;
            _renderer.sharedMaterial.color = Color.red;
            Assert.That(TryBakePrefab(), Does.Contain(locked).And.Contain("version control"));
            Assert.That(mesh.vertexCount, Is.EqualTo(vertices));
            foreach (string path in new[] { MeshPath, MaterialPath, PrefabPath })
                Assert.That(EditorDriver.IsSaved(path), Is.True, path);
        }

        [Test]
        public void WhatIsBakedAgainIsInTheFiles()
        {
            UseMaterialOfItsOwn();
            Assert.That(TryBakePrefab(), Is.Empty);
            string mesh = File.ReadAllText(MeshPath);
            _surface.Spacing /= 2;
            _renderer.sharedMaterial.color = Color.red;
            Assert.That(TryBakePrefab(), Is.Empty);
            Assert.That(File.ReadAllText(MeshPath), Is.Not.EqualTo(mesh));
            Assert.That(AssetDatabase.LoadAssetAtPath<Material>(MaterialPath).color, Is.EqualTo(Color.red));
            foreach (string path in new[] { MeshPath, MaterialPath, PrefabPath })
                Assert.That(EditorDriver.IsSaved(path), Is.True, path);
        }

        [Test]
        public void NothingIsLeftInMemoryOfWhatCannotBeSaved()
        {
            UseMaterialOfItsOwn();
            Assert.That(_surface.ComputeNow(), Is.True);
            int meshes = Engine.LiveObjects<Mesh>(), materials = Engine.LiveObjects<Material>();
            int objects = Engine.LiveObjects<GameObject>();
            EditorDriver.IsDiskFull = true;
            Assert.That(TryBakePrefab(), Does.Contain(MeshPath));
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(meshes));

            EditorDriver.IsDiskFull = false;
            Assert.That(SurfaceBaker.TryBake(_surface, MeshPath, out _, out string error), Is.True, error);
            EditorDriver.IsDiskFull = true; // the mesh is there, and is written into
            Assert.That(TryBakePrefab(), Does.Contain(MaterialPath));
            Assert.That(Engine.LiveObjects<Material>(), Is.EqualTo(materials));
            Assert.That(Engine.LiveObjects<GameObject>(), Is.EqualTo(objects));

            _renderer.sharedMaterial = null;
            LogAssert.Expect(LogType.Error, new Regex(PrefabPath));
            Assert.That(TryBakePrefab(), Does.Contain(PrefabPath));
            Assert.That(Engine.LiveObjects<GameObject>(), Is.EqualTo(objects));
        }

        [Test]
        public void BakingAgainAndAgainLeavesNoMoreThanOnce()
        {
            UseMaterialOfItsOwn();
            Assert.That(TryBakePrefab(), Is.Empty);
            int all = Engine.LiveObjects<Object>();
            for (int k = 0; k < 3; ++k)
                Assert.That(TryBakePrefab(), Is.Empty);
            Assert.That(Engine.LiveObjects<Object>(), Is.EqualTo(all));
        }

        [Test]
        public void ASurfaceInAnOpenPrefabIsNotBakedOverIt([Values] bool isSaved)
        {
            Object.DestroyImmediate(_surface.gameObject);
            var root = new GameObject("root");
            if (isSaved)
                SurfaceCreator.CreateEmpty(root);
            PrefabUtility.SaveAsPrefabAsset(root, PrefabPath);
            GameObject opened = EditorDriver.OpenPrefab(PrefabPath);
            _surface = isSaved
                ? opened.GetComponentInChildren<MolecularSurface>(true)
                : SurfaceCreator.CreateEmpty(opened);
            CreatedSurfaces.GiveAtoms(_surface);
            string text = File.ReadAllText(PrefabPath);
            Assert.That(TryBakePrefab(), Does.Contain(PrefabPath));
            Assert.That(File.ReadAllText(PrefabPath), Is.EqualTo(text));
            Assert.That(AssetDatabase.LoadMainAssetAtPath(MeshPath) == null, Is.True);
            Assert.That(PrefabBaker.TryBake(_surface, "Assets/b.prefab", out _, out string error), Is.True, error);
        }

        [Test]
        public void AssetsOfPrefabsAreNotBaked()
        {
            var prefab = PrefabUtility.SaveAsPrefabAsset(_surface.gameObject, PrefabPath);
            Assert.That(SurfaceBaker.TryBake(prefab.GetComponent<MolecularSurface>(), MeshPath, out _, out string error),
                Is.False);
            Assert.That(error, Does.Contain("not active"));
        }

        [Test]
        public void NothingHappensWhenThePanelIsCancelled([Values] bool isPrefab)
        {
            Bake(isPrefab);
            Assert.That(EditorDriver.Shown, Is.EqualTo(new[] { isPrefab ? "panel: name.prefab" : "panel: name.asset" }));
            Assert.That(_surface.CurrentLevel.LevelCount, Is.Zero);
        }

        [Test]
        public void WhatWasBakedIsShownInTheProject([Values] bool isPrefab)
        {
            EditorDriver.ChosenPath = isPrefab ? PrefabPath : MeshPath;
            Bake(isPrefab);
            Assert.That(EditorDriver.Shown.Last(), Is.EqualTo("ping: " + EditorDriver.ChosenPath));
            Assert.That(EditorDriver.ShowsProgress, Is.False);
        }

        [Test]
        public void OtherAssetsAreNotReplacedUnlessTheUserAgrees([Values] bool agrees)
        {
            UseMaterialOfItsOwn();
            Assert.That(TryBakePrefab(), Is.Empty);
            string mesh = File.ReadAllText(MeshPath);
            _surface.Spacing /= 2;
            _renderer.sharedMaterial.color = Color.red;
            EditorDriver.ChosenPath = PrefabPath;
            EditorDriver.Agrees = agrees;
            Bake(true);
            Assert.That(EditorDriver.Shown[1], Does.StartWith("dialog").And.Contain(MeshPath).And.Contain(MaterialPath));
            Assert.That(File.ReadAllText(MeshPath) != mesh, Is.EqualTo(agrees));
            Color saved = AssetDatabase.LoadAssetAtPath<Material>(MaterialPath).color;
            Assert.That(saved.Equals(Color.red), Is.EqualTo(agrees));
            Assert.That(EditorDriver.Shown.Last().StartsWith("ping"), Is.EqualTo(agrees));
        }

        [Test]
        public void WhatIsCancelledLeavesNothingAndTheSurfaceGoesOn([Values] bool isPrefab, [Values] bool isStarting)
        {
            GiveManyAtoms();
            if (isStarting)
            {
                SurfaceScheduler.ReleaseContexts();
                NativeGate.Close();
            }
            EditorDriver.ChosenPath = isPrefab ? PrefabPath : MeshPath;
            EditorDriver.Cancels = true;
            Bake(isPrefab);
            Assert.That(EditorDriver.Shown.Last(), Is.EqualTo("dialog: It was cancelled."));
            Assert.That(EditorDriver.ShowsProgress, Is.False);
            Assert.That(Directory.GetFiles("Assets"), Is.Empty);
            NativeGate.Open();
            Settle();
            Assert.That(_surface.CurrentLevel.IsFinest, Is.True);
            Assert.That(_surface.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
        }

        [Test]
        public void ASurfaceThatWasAtRestGoesOnWhereItsBakingWasCancelled()
        {
            GiveManyAtoms();
            Engine.Frame();
            _surface.Cancel();
            Settle();
            Assert.That(_surface.CurrentLevel.IsFinest, Is.False);
            Assert.That(SurfaceBaker.TryBake(_surface, MeshPath, () => false, out _, out _), Is.False);
            FramesUntil(() => _surface.CurrentLevel.IsFinest);
        }

        [Test]
        public void TheReasonIsNotThatOfAFailureBefore()
        {
            _surface.Failed += _ => { };
            _surface.SetPositions(new[] { Vector3.zero, new Vector3(float.NaN, 0, 0) });
            Assert.That(_surface.ComputeNow(), Is.False);
            CreatedSurfaces.GiveAtoms(_surface);
            SurfaceScheduler.ReleaseContexts();
            NativeGate.Close(); // so that there is something to be cancelled
            Assert.That(SurfaceBaker.TryBake(_surface, MeshPath, () => false, out _, out string error), Is.False);
            Assert.That(error, Is.EqualTo("It was cancelled."));
        }

        [Test]
        public void WhatIsShownInFullIsNotComputedAgain()
        {
            Assert.That(_surface.ComputeNow(), Is.True);
            uint job = SurfaceScheduler.LastJob;
            Assert.That(TryBakePrefab(), Is.Empty);
            Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(job));
            _surface.SetPositions(new[] { Vector3.zero, new Vector3(1, 0, 0) });
            Assert.That(TryBakePrefab(), Is.Empty);
            Assert.That(SurfaceScheduler.LastJob, Is.Not.EqualTo(job));
        }

        [Test]
        public void ASurfaceThatIsPlayedIsBakedAsItStandsAndGoesOn()
        {
            Engine.EnterPlayModeWithoutReload();
            var player = new GameObject("played").AddComponent<TrajectoryPlayer>();
            player.PlayOnEnable = false;
            player.StructureSource.SetAsset(Ensemble(20));
            Assert.That(player.Load(), Is.True, player.LastError.ToString());
            _surface = player.GetComponent<MolecularSurface>();
            FramesUntil(() => player.ShownFrame == 0);
            player.Play();
            FramesUntil(() => player.ShownFrame > 2);
            float shift = _surface.Positions[0].z;
            Assert.That(SurfaceBaker.TryBake(_surface, MeshPath, out Mesh asset, out string error), Is.True, error);
            Assert.That(_surface.Positions[0].z, Is.EqualTo(shift));
            Assert.That(_surface.CurrentLevel.IsFinest && _surface.CurrentLevel.HasCreases, Is.True);
            Assert.That(asset.vertexCount, Is.EqualTo(_surface.CurrentLevel.VertexCount));
            Assert.That(asset.bounds.center.z, Is.EqualTo(shift).Within(0.1));
            int shown = player.ShownFrame;
            FramesUntil(() => player.ShownFrame != shown);
            player.Pause();
            Settle();
            Assert.That(_surface.Mesh.bounds.center.z, Is.Not.EqualTo(shift).Within(0.1), "it goes on");
            Assert.That(EditorDriver.IsSaved(MeshPath), Is.True, "it does not change with the surface");
        }

        [Test]
        public void ASurfaceThatNeverRestsIsBakedWithItsCreases()
        {
            Settle();
            _surface.RestDelay = float.PositiveInfinity;
            _surface.FrameBudget = 0; // all levels
            _surface.SetPositions(new[] { Vector3.zero, new Vector3(2, 0, 0) });
            Settle();
            Assert.That(_surface.CurrentLevel.IsFinest && !_surface.CurrentLevel.HasCreases, Is.True);
            Assert.That(TryBakePrefab(), Is.Empty);
            Assert.That(_surface.CurrentLevel.HasCreases, Is.True);
        }

        [Test]
        public void WhatCantLeaveTheGpuIsTold()
        {
            using (var gpu = new StandInGpu { DownloadsFail = true })
            {
                GpuDelivery.Library = gpu;
                SurfaceScheduler.Delivery = SurfaceDelivery.Device;
                Assert.That(_surface.ComputeNow(), Is.True, _surface.LastError.Message);
                Assert.That(_surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
                int meshes = Engine.LiveObjects<Mesh>();
                Assert.That(SurfaceBaker.TryBake(_surface, MeshPath, out Mesh asset, out string error), Is.False);
                Assert.That(error, Does.Contain("no memory"));
                Assert.That(asset == null, Is.True);
                Assert.That(TryBakePrefab(), Does.Contain("no memory"));
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(meshes));
                Assert.That(Directory.GetFiles("Assets"), Is.Empty);
                gpu.DownloadsFail = false;
                Assert.That(TryBakePrefab(), Is.Empty);
                Object.DestroyImmediate(_surface.gameObject);
            }
        }

        [Test]
        public void UndoLeavesWhatWasBaked()
        {
            Undo.IncrementCurrentGroup();
            Assert.That(TryBakePrefab(), Is.Empty);
            Undo.PerformUndo(); // of the surface's creation
            Assert.That(_surface == null, Is.True);
            Assert.That(AssetDatabase.LoadAssetAtPath<GameObject>(PrefabPath).GetComponent<MeshFilter>().sharedMesh,
                Is.SameAs(AssetDatabase.LoadAssetAtPath<Mesh>(MeshPath)));
            Assert.That(EditorDriver.IsSaved(MeshPath) && EditorDriver.IsSaved(PrefabPath), Is.True);
        }

        // Of which the surface takes longer than a look at how it goes on.
        private void GiveManyAtoms()
        {
            var positions = new Vector3[1000];
            var radii = new float[positions.Length];
            for (int k = 0; k < positions.Length; ++k)
                (positions[k], radii[k]) = (new Vector3(3 * (k % 10), 3 * (k / 10 % 10), 3 * (k / 100)), 1.7f);
            _surface.SetAtoms(positions, radii);
            _surface.Spacing = 0.1f;
        }

        private void UseMaterialOfItsOwn() => _renderer.sharedMaterial = new Material(_renderer.sharedMaterial);

        private void Bake(bool isPrefab) => EditorDriver.InvokeContextMenu(
            isPrefab ? MolecularMenu.BakePrefab : MolecularMenu.BakeMesh, _surface);

        // The error.
        private string TryBakePrefab()
        {
            bool isBaked = PrefabBaker.TryBake(_surface, PrefabPath, out GameObject prefab, out string error);
            Assert.That(isBaked, Is.EqualTo(error.Length == 0 && prefab != null));
            return error;
        }

        private void Settle() => FramesUntil(() => !_surface.IsBusy);

        private static void FramesUntil(Func<bool> condition)
        {
            for (int frame = 0; frame < MostFrames && !condition(); ++frame)
                Engine.Frame();
            Assert.That(condition(), Is.True);
        }

        // Two atoms that move along z, 1 Å a frame.
        private static TextAsset Ensemble(int frames)
        {
            var text = new StringBuilder();
            for (int model = 1; model <= frames; ++model)
            {
                text.Append(FormattableString.Invariant($"MODEL     {model,4}\n"));
                for (int i = 1; i <= 2; ++i)
                    text.Append(FormattableString.Invariant(
                        $"ATOM  {i,5}  CA  ALA A{i,4}    {3 * i,8:0.000}   0.000{model,8:0.000}  1.00  0.00           C\n"));
                text.Append("ENDMDL\n");
            }
            return new TextAsset(text.ToString()) { name = "ensemble.pdb" };
        }
    }
}
