// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.Linq;
using System.Reflection;
using UnityEngine;

namespace QuickSes.Tests
{
    public sealed class SourceFormTest
    {
        [Test]
        public void EverySerialisedFieldOfASourceHasARow()
        {
            string[] rows = SourceForm.Rows.Select(row => row.Property).Append("_kind").ToArray();
            Assert.That(rows, Is.EquivalentTo(SerialisedFields<MoleculeSource>()));
            Assert.That(SerialisedFields<TrajectorySource>(), Is.SubsetOf(rows));
        }

        [Test]
        public void NothingIsAskedAboutASourceThatIsNone()
        {
            Assert.That(SourceForm.OfStructure(MoleculeSourceKind.None, StructureFormat.Auto, "1crn.pdb"),
                Is.EqualTo(SourceFields.None));
            Assert.That(SourceForm.OfTrajectory(MoleculeSourceKind.None), Is.EqualTo(SourceFields.None));
        }

        [TestCase(MoleculeSourceKind.TextAsset, SourceFields.Asset, SourceFields.Path)]
        [TestCase(MoleculeSourceKind.TextAsset, SourceFields.Asset, SourceFields.Molecule)]
        [TestCase(MoleculeSourceKind.MoleculeAsset, SourceFields.Molecule, SourceFields.Asset | SourceFields.Path)]
        [TestCase(MoleculeSourceKind.StreamingAssets, SourceFields.Path, SourceFields.Asset)]
        [TestCase(MoleculeSourceKind.File, SourceFields.Path, SourceFields.Asset)]
        public void AssetOrPathIsShownAsTheKindSays(MoleculeSourceKind kind, object shown, object hidden)
        {
            SourceFields structure = SourceForm.OfStructure(kind, StructureFormat.Auto, "");
            SourceFields trajectory = SourceForm.OfTrajectory(kind);
            foreach (SourceFields fields in new[] { structure, trajectory })
            {
                Assert.That(fields & (SourceFields)shown, Is.EqualTo(shown));
                Assert.That(fields & (SourceFields)hidden, Is.EqualTo(SourceFields.None));
            }
        }

        [TestCase(StructureFormat.Pdb, "a.xyzr", true)]
        [TestCase(StructureFormat.Auto, "a.cif.gz", true)]
        [TestCase(StructureFormat.Auto, null, true)]
        [TestCase(StructureFormat.Auto, "a.xyzr.gz", false)]
        [TestCase(StructureFormat.Xyzr, "a.pdb", false)]
        public void FiltersAreShownUnlessTheFormatHasNothingToFilterBy(StructureFormat format, string name, bool shown)
        {
            SourceFields fields = SourceForm.OfStructure(MoleculeSourceKind.File, format, name);
            Assert.That(fields & SourceFields.Filters, Is.EqualTo(shown ? SourceFields.Filters : SourceFields.None));
            Assert.That(fields & SourceFields.Radii, Is.EqualTo(SourceFields.Radii));
        }

        [TestCase("a.pdb", true)]
        [TestCase("a.cif.gz", true)]
        [TestCase("a", true)]
        [TestCase("a.pqr", false)]
        [TestCase("a.gro", false)]
        [TestCase("a.xyzr", false)]
        public void AssembliesAndAlternateLocationsAreShownWhereThereMayBeSome(string name, bool shown)
        {
            const SourceFields both = SourceFields.Assembly | SourceFields.AlternateLocation;
            SourceFields fields = SourceForm.OfStructure(MoleculeSourceKind.File, StructureFormat.Auto, name);
            Assert.That(fields & both, Is.EqualTo(shown ? both : SourceFields.None));
        }

        [Test]
        public void OnlyAbsolutePathsComeWithAHint()
        {
            Assert.That(SourceForm.HintOf(MoleculeSourceKind.File), Does.Contain("StreamingAssets"));
            Assert.That(SourceForm.HintOf(MoleculeSourceKind.StreamingAssets), Is.Null);
            Assert.That(SourceForm.HintOf(MoleculeSourceKind.TextAsset), Is.Null);
            Assert.That(SourceForm.HintOf(MoleculeSourceKind.None), Is.Null);
        }

        private static string[] SerialisedFields<T>() where T : FileSource =>
            new[] { typeof(T), typeof(FileSource) }.SelectMany(type => type
                .GetFields(BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.DeclaredOnly))
            .Where(field => field.IsDefined(typeof(SerializeField)))
            .Select(field => field.Name).ToArray();
    }
}
