// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.IO;
using System.IO.Compression;
using System.Linq;
using System.Text;
using UnityEngine;

namespace QuickSes.Tests
{
    public sealed class MoleculeSourceTest
    {
        private const string Xyzr = "0 0 0 1.5\n1 2 3 1.7\n";

        private TestFolder _folder;

        [SetUp]
        public void MakeFolder() => _folder = new TestFolder();

        [TearDown]
        public void DeleteFolder() => _folder.Dispose();

        private static Structure Open(MoleculeSource source)
        {
            Assert.That(source.TryOpen(out Structure structure, out QuickSesError error), Is.True, error.ToString());
            return structure;
        }

        private static QuickSesError Fail(MoleculeSource source)
        {
            Assert.That(source.TryOpen(out Structure structure, out QuickSesError error), Is.False);
            Assert.That(structure, Is.Null);
            Assert.That(error.Status, Is.Not.EqualTo(QuickSesStatus.Ok));
            return error;
        }

        private static MoleculeSource OfText(string name, string text)
        {
            var source = new MoleculeSource();
            source.SetAsset(new TextAsset(text) { name = name });
            return source;
        }

        private MoleculeSource OfFile(string name, byte[] bytes)
        {
            var source = new MoleculeSource();
            source.SetFile(_folder.Write(name, bytes));
            return source;
        }

        private static byte[] Gzipped(string text)
        {
            using (var stream = new MemoryStream())
            {
                using (var gzip = new GZipStream(stream, CompressionMode.Compress))
                    gzip.Write(Encoding.ASCII.GetBytes(text), 0, text.Length);
                return stream.ToArray();
            }
        }

        [Test]
        public void TextAssetsAreReadWithoutTheirWaters()
        {
            MoleculeSource source = OfText("small.pdb", TestFrames.Pdb(1));
            Assert.That(source.IsSet, Is.True);
            using (Structure structure = Open(source))
            {
                Assert.That(structure.AtomCount, Is.EqualTo(TestFrames.AtomCount - 1));
                Assert.That(structure.FileIndices.ToArray(), Is.EqualTo(TestFrames.WithoutWater));
                Assert.That(structure.FileAtomCount, Is.EqualTo(TestFrames.AtomCount));
            }
            source.SkipWater = false;
            using (Structure structure = Open(source))
                Assert.That(structure.AtomCount, Is.EqualTo(TestFrames.AtomCount));
            source.Selection = "//A/1/CA";
            using (Structure structure = Open(source))
                Assert.That(structure.GetAtom(structure.AtomCount - 1).Name, Is.EqualTo("CA"));
            source.Selection = "";
            source.Radii = "bondi";
            source.Model = 2;
            Assert.That(Fail(source).Message, Does.Contain("model").And.Contain("small.pdb"));
        }

        [Test]
        public void AssembliesAreMadeAndAlternateLocationsChosen()
        {
            MoleculeSource source = OfText("pair.pdb",
                "REMARK 350 BIOMOLECULE: 1\n" +
                "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n" +
                "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n" +
                "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n" +
                "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n" +
                "REMARK 350   BIOMT1   2  1.000000  0.000000  0.000000       10.00000\n" +
                "REMARK 350   BIOMT2   2  0.000000  1.000000  0.000000        0.00000\n" +
                "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        0.00000\n" +
                "ATOM      1  CA AALA A   1       1.000   0.000   0.000  0.40  0.00           C\n" +
                "ATOM      2  CA BALA A   1       2.000   0.000   0.000  0.60  0.00           C\n" +
                "END\n");
            Assert.That(XOf(source), Is.EqualTo(new[] { 1f }));
            source.AlternateLocation = "B";
            Assert.That(XOf(source), Is.EqualTo(new[] { 2f }));
            source.Assembly = "1";
            Assert.That(XOf(source), Is.EqualTo(new[] { 2f, 12f }));
            source.Assembly = " ";
            source.AlternateLocation = "highest";
            Assert.That(XOf(source), Is.EqualTo(new[] { 2f }));
            source.Assembly = "7";
            Assert.That(Fail(source).Message, Does.Contain("'7'").And.Contain("pair.pdb"));
            source.Assembly = source.AlternateLocation = null;
            Assert.That(source.Assembly + source.AlternateLocation, Is.EqualTo(""));
        }

        private static float[] XOf(MoleculeSource source)
        {
            using (Structure structure = Open(source))
                return structure.Positions.ToArray().Where((_, i) => i % 3 == 0).ToArray();
        }

        [Test]
        public void MoleculeAssetsAreReadAsFilesAre()
        {
            var source = new MoleculeSource();
            MoleculeSource before;
            MoleculeAsset asset = MoleculeAsset.Create("folder/small.pdb.gz", Gzipped(TestFrames.Pdb(1)));
            try
            {
                Assert.That(asset.name, Is.EqualTo("small.pdb"));
                source.SetAsset(asset);
                Assert.That(source.Kind, Is.EqualTo(MoleculeSourceKind.MoleculeAsset));
                Assert.That(source.IsSet, Is.True);
                using (Structure structure = Open(source))
                    Assert.That(structure.FileIndices.ToArray(), Is.EqualTo(TestFrames.WithoutWater));
                before = source.Copy();
                Assert.That(source.IsSameAs(before), Is.True);
                MoleculeSource other = source.Copy();
                other.Molecule = null;
                Assert.That(source.IsSameAs(other), Is.False);
                Assert.That(Fail(other).Message, Does.Contain("molecule asset"));
            }
            finally
            {
                Object.DestroyImmediate(asset);
            }
            Assert.That(source.IsSet, Is.False);
            Assert.That(source.IsSameAs(before), Is.True, "nobody has chosen another one");
            Assert.That(Fail(source).Message, Does.Contain("molecule asset"));
            source.SetAsset(MoleculeAsset.Create("nothing.cif", new byte[0]));
            Assert.That(Fail(source).Message, Does.Contain("nothing.cif").And.Contain("empty"));
            Object.DestroyImmediate(source.Molecule);
        }

        [TestCase("a.pdb", StructureFormat.Pdb)]
        [TestCase("a.PDB.gz", StructureFormat.Pdb)]
        [TestCase("a.pdb.gz.bytes", StructureFormat.Pdb)]
        [TestCase("a.ent.txt", StructureFormat.Pdb)]
        [TestCase("a.cif", StructureFormat.Mmcif)]
        [TestCase("a.b.mmcif.bytes", StructureFormat.Mmcif)]
        [TestCase("a.pqr.txt", StructureFormat.Pqr)]
        [TestCase("a.xyzr", StructureFormat.Xyzr)]
        [TestCase("/some.pdb/a.gro.gz", StructureFormat.Gro)]
        [TestCase("a", StructureFormat.Auto)]
        [TestCase("a.bytes", StructureFormat.Auto)]
        [TestCase("", StructureFormat.Auto)]
        public void NamesTellTheFormat(string name, StructureFormat format) =>
            Assert.That(MoleculeFile.StructureFormatOf(name), Is.EqualTo(format));

        [TestCase("a.dcd.bytes", TrajectoryFormat.Dcd)]
        [TestCase("a.xtc", TrajectoryFormat.Xtc)]
        [TestCase("a.trr.gz", TrajectoryFormat.Trr)]
        [TestCase("a.nc", TrajectoryFormat.Netcdf)]
        [TestCase("a.ncdf.gz.bytes", TrajectoryFormat.Netcdf)]
        [TestCase("a.ncrst", TrajectoryFormat.Netcdf)]
        [TestCase("a.pdb.gz.bytes", TrajectoryFormat.Pdb)]
        [TestCase("a.gro", TrajectoryFormat.Auto)]
        public void NamesTellTheFormatOfFrames(string name, TrajectoryFormat format) =>
            Assert.That(MoleculeFile.TrajectoryFormatOf(name), Is.EqualTo(format));

        [Test]
        public void FilesOnDiskMayBeCalledAsAssets()
        {
            string text = TestFrames.Pdb(1);
            foreach (string name in new[] { "a.pdb.gz", "a.pdb.gz.bytes", "a.txt" })
                using (Structure structure = Open(OfFile(name, Gzipped(text))))
                    Assert.That(structure.Format, Is.EqualTo(StructureFormat.Pdb), name);
            using (Structure structure = Open(OfFile("a.xyzr.txt", Encoding.ASCII.GetBytes(Xyzr))))
                Assert.That(structure.Format, Is.EqualTo(StructureFormat.Xyzr));
        }

        [Test]
        public void FilesWithoutResiduesHaveNoWatersToSkip()
        {
            MoleculeSource source = OfText("two.xyzr", Xyzr);
            Assert.That(source.SkipWater, Is.True);
            using (Structure structure = Open(source))
                Assert.That(structure.Radii.ToArray(), Is.EqualTo(new[] { 1.5f, 1.7f }));
            source.SkipHydrogen = true; // that was asked for, so it is told
            Assert.That(Fail(source).Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
        }

        [Test]
        public void FormatOverrulesTheName()
        {
            MoleculeSource source = OfText("two.pdb", Xyzr);
            source.Format = StructureFormat.Xyzr;
            using (Structure structure = Open(source))
                Assert.That(structure.AtomCount, Is.EqualTo(2));
        }

        [Test]
        public void WhatIsMissingIsNamed()
        {
            var source = new MoleculeSource();
            Assert.That(source.IsSet, Is.False);
            Assert.That(Fail(source).Message, Does.Contain("chosen"));
            source.Kind = MoleculeSourceKind.TextAsset;
            Assert.That(source.IsSet, Is.False);
            Assert.That(Fail(source).Message, Does.Contain("text asset"));
            Assert.That(Fail(OfText("nothing.pdb", "")).Message, Does.Contain("nothing.pdb").And.Contain("empty"));

            source.Kind = MoleculeSourceKind.File;
            Assert.That(source.IsSet, Is.False);
            Assert.That(Fail(source).Message, Does.Contain("path"));
            source.Path = " ";
            Assert.That(source.IsSet, Is.False);
            source.Path = Path.Combine(_folder.Root, "no such.pdb");
            Assert.That(source.IsSet, Is.True);
            Assert.That(Fail(source).Status, Is.EqualTo(QuickSesStatus.FileError));
            Assert.That(Fail(source).Message, Does.Contain(source.Path));
            source.Path = "some.pdb";
            Assert.That(Fail(source).Message, Does.Contain("'some.pdb' is not an absolute path"));
            source.Path = _folder.Root;
            Assert.That(Fail(source).Message, Does.Contain("folder"));
            source.Path = null;
            Assert.That(source.Path, Is.EqualTo(""));
            source.Kind = (MoleculeSourceKind)99;
            Assert.That(Fail(source).Message, Does.Contain("99"));

            QuickSesError error = Fail(OfFile("broken.pdb", Encoding.ASCII.GetBytes("ATOM  nonsense\n")));
            Assert.That(error.Message, Does.Contain("broken.pdb"));
            Assert.That(Fail(OfText("broken.pdb", "ATOM  nonsense\n")).Message, Does.Contain("'broken.pdb'"));
        }

        [Test]
        public void StreamingAssetsMustBeAFolder()
        {
            string path = _folder.Write("a.pdb", TestFrames.Pdb(1));
            Assert.That(MoleculeFile.TryFindStreamed(_folder.Root, "a.pdb", out MoleculeFile file, out _), Is.True);
            Assert.That(file.Path, Is.EqualTo(path));
            Assert.That(MoleculeFile.TryFindStreamed(_folder.Root, "b.pdb", out file, out QuickSesError error),
                Is.False);
            Assert.That(file, Is.Null);
            Assert.That(error.Message, Does.Contain(Path.Combine(_folder.Root, "b.pdb")));
            foreach (string root in new[]
                { "jar:file:///data/app/base.apk!/assets", "https://example.org/s", "", null })
            {
                Assert.That(MoleculeFile.TryFindStreamed(root, "a.pdb", out file, out error), Is.False);
                Assert.That(error.Message, Does.Contain("no folder").And.Contain("asset"));
            }
            Assert.That(MoleculeFile.TryFindStreamed(_folder.Root, " ", out file, out error), Is.False);
            Assert.That(MoleculeFile.TryFindStreamed(_folder.Root, path, out file, out error), Is.False);
            Assert.That(error.Message, Does.Contain("absolute"));
        }
    }
}
