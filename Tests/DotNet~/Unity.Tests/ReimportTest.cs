// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using System.Reflection;
using System.Text;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Molecule assets that are imported anew: the same object, other bytes.</summary>
    internal sealed class ReimportTest
    {
        private SurfaceRig _rig;

        private MolecularSurface Surface => _rig.Surface;

        [TearDown]
        public void Destroy() => _rig?.Dispose();

        [UnityTest]
        public IEnumerator ASurfaceShowsTheNewOne([Values] bool isEditMode)
        {
            if (isEditMode)
                Engine.EnterEditMode();
            MoleculeAsset asset = MoleculeAsset.Create("a.pdb", Pdb("ALA", 2));
            _rig = new SurfaceRig();
            Surface.Source.SetAsset(asset);
            Surface.BeginLoadSource();
            yield return _rig.Settle();
            Surface.FollowSourceSoon(); // another asset was imported
            yield return null;
            Assert.That(Surface.IsLoading, Is.False);
            Import(asset, Pdb("GLY", 3));
            Surface.FollowSourceSoon();
            yield return SurfaceRig.Until(() => Surface.AtomCount == 3);
            yield return _rig.Settle();
            Assert.That(Surface.Structure.GetAtom(2).ResidueName, Is.EqualTo("GLY"));
            Assert.That(_rig.Failures, Is.Empty);
            Object.DestroyImmediate(asset);
        }

        [UnityTest]
        public IEnumerator UntilThenTheStructureIsThatOfWhatIsShown()
        {
            MoleculeAsset asset = MoleculeAsset.Create("a.pdb", Pdb("ALA", 2));
            _rig = new SurfaceRig();
            Surface.Source.SetAsset(asset);
            Surface.BeginLoadSource();
            yield return _rig.Settle();
            Import(asset, Pdb("GLY", 2));
            Assert.That(Surface.Structure.GetAtom(1).ResidueName, Is.EqualTo("ALA"));
            Object.DestroyImmediate(asset);
        }

        [UnityTest]
        public IEnumerator APlayerPlaysTheNewOneFromWhereItIs([Values] bool isOfSurface)
        {
            using (var playing = new PlayerFixture())
            {
                MoleculeAsset asset = MoleculeAsset.Create("a.pdb", Encoding.ASCII.GetBytes(TestFrames.Pdb(5)));
                (isOfSurface ? playing.Surface.Source : playing.Player.StructureSource).SetAsset(asset);
                playing.Load();
                playing.Player.Frame = 3;
                playing.WaitUntilShown(3);
                playing.Player.FollowEdits();
                yield return null;
                Assert.That(playing.Player.IsLoading, Is.False);
                Import(asset, Encoding.ASCII.GetBytes(TestFrames.Pdb(9)));
                playing.Player.FollowEdits();
                yield return SurfaceRig.Until(() => playing.Player.FrameCount == 9 && playing.Player.ShownFrame >= 0);
                playing.AssertShows(3);
                Object.DestroyImmediate(asset);
            }
        }

        private static void Import(MoleculeAsset asset, byte[] bytes) => typeof(MoleculeAsset)
            .GetField("_bytes", BindingFlags.Instance | BindingFlags.NonPublic).SetValue(asset, bytes);

        private static byte[] Pdb(string residue, int atoms)
        {
            var text = new StringBuilder();
            for (int i = 1; i <= atoms; ++i)
                text.Append($"ATOM  {i,5}  CA  {residue} A{i,4}    {4 * i,4}.000   0.000   0.000  1.00  0.00")
                    .Append("           C\n");
            return Encoding.ASCII.GetBytes(text.Append("END\n").ToString());
        }
    }
}
