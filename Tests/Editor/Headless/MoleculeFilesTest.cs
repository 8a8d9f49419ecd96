// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System;
using System.IO;
using System.IO.Compression;
using System.Text;

namespace QuickSes.Tests
{
    /// <summary>Files whose extensions others use, too.</summary>
    public sealed class MoleculeFilesTest
    {
        private const string Pdb = "REMARK   1\nATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00\n";

        private string _folder;

        [SetUp]
        public void MakeFolder()
        {
            _folder = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
            Directory.CreateDirectory(_folder);
        }

        [TearDown]
        public void DeleteFolder() => Directory.Delete(_folder, true);

        private bool IsMolecule(string name, byte[] bytes)
        {
            string path = Path.Combine(_folder, name);
            File.WriteAllBytes(path, bytes);
            return MoleculeFiles.IsMolecule(path);
        }

        private bool IsMolecule(string name, string text) => IsMolecule(name, Encoding.ASCII.GetBytes(text));

        private static byte[] Gzipped(byte[] bytes)
        {
            using (var stream = new MemoryStream())
            {
                using (var gzip = new GZipStream(stream, CompressionMode.Compress))
                    gzip.Write(bytes, 0, bytes.Length);
                return stream.ToArray();
            }
        }

        private static byte[] Gzipped(string text) => Gzipped(Encoding.ASCII.GetBytes(text));

        [Test]
        public void StructuresAreMolecules()
        {
            Assert.That(IsMolecule("a.pdb", Pdb), Is.True);
            Assert.That(IsMolecule("a.PDB", "\r\nHETATM    1 ZN    ZN A   1\r\n"), Is.True);
            Assert.That(IsMolecule("a.pdb.gz", Gzipped(Pdb)), Is.True);
            Assert.That(IsMolecule("a.cif.gz", Gzipped("data_1AON\n")), Is.True);
            Assert.That(IsMolecule("a.gro.GZ", Gzipped("title\n 1\n")), Is.True);
            Assert.That(IsMolecule("md.xtc.gz", Gzipped(new byte[] { 0, 0, 7, 203 })), Is.True);
        }

        // As Chimera writes large proteins: the first atom is far behind.
        [TestCase("HELIX    1   1 ALA A   10  ALA A   16  1")]
        [TestCase("SHEET    1   A 2 LEU A   5  SER A   9  0")]
        [TestCase("SEQRES   1 A   46  THR THR CYS CYS PRO SER ILE VAL ALA")]
        [TestCase("SSBOND   1 CYS A    3    CYS A   40")]
        public void WhatComesBeforeTheAtomsOfAStructureIsKnown(string line)
        {
            var text = new StringBuilder();
            for (int k = 0; k < 200; ++k)
                text.Append(line.PadRight(80)).Append('\n');
            Assert.That(IsMolecule("a.pdb", text + Pdb), Is.True);
        }

        [Test]
        public void DebugDatabasesAreNone()
        {
            byte[] portable = { (byte)'B', (byte)'S', (byte)'J', (byte)'B', 1, 0, 1, 0, 0, 0, 0, 0 };
            Assert.That(IsMolecule("a.pdb", portable), Is.False);
            Assert.That(IsMolecule("a.pdb", "Microsoft C/C++ MSF 7.00\r\n\u001aDS\0\0\0"), Is.False);
            Assert.That(IsMolecule("a.pdb", "Microsoft C/C++ MSF 7.00\r\n\0\nATOM  "), Is.False);
            Assert.That(IsMolecule("a.pdb", ""), Is.False);
            Assert.That(IsMolecule("a.pdb.gz", Gzipped(portable)), Is.False);
        }

        [Test]
        public void OtherArchivesAreNone()
        {
            Assert.That(IsMolecule("a.tar.gz", Gzipped(Pdb)), Is.False);
            Assert.That(IsMolecule("levels.json.gz", Gzipped("{}")), Is.False);
            Assert.That(IsMolecule("a.gz", Gzipped(Pdb)), Is.False);
            Assert.That(IsMolecule("a.cif.gz", Gzipped("")), Is.False);
        }

        [Test]
        public void WhatCannotBeReadIsNone()
        {
            Assert.That(IsMolecule("a.pdb.gz", Pdb), Is.False, "not packed");
            byte[] whole = Gzipped(new string('A', 100000) + Pdb);
            Array.Resize(ref whole, 12);
            Assert.That(IsMolecule("a.pdb.gz", whole), Is.False, "cut off");
            Assert.That(MoleculeFiles.IsMolecule(Path.Combine(_folder, "none.pdb")), Is.False);
            Directory.CreateDirectory(Path.Combine(_folder, "folder.pdb"));
            Assert.That(MoleculeFiles.IsMolecule(Path.Combine(_folder, "folder.pdb")), Is.False);
        }

        [TestCase("md.xtc", true)]
        [TestCase("md.DCD.gz", true)]
        [TestCase("md.trr", true)]
        [TestCase("md.nc", true)]
        [TestCase("a.pdb", false)]
        [TestCase("a.gro", false)]
        [TestCase("a", false)]
        public void TrajectoriesAreKnownByTheirNames(string name, bool isOne) =>
            Assert.That(MoleculeFiles.IsTrajectory(name), Is.EqualTo(isOne));

        [TestCase("Assets/StreamingAssets/md.xtc", true)]
        [TestCase("Assets/streamingassets/sub/md.xtc", true)]
        [TestCase("Assets/Molecules/StreamingAssets/md.xtc", false)]
        [TestCase("Assets/StreamingAssets.xtc", false)]
        public void StreamingAssetsIsOneFolder(string path, bool isIn) =>
            Assert.That(MoleculeFiles.IsStreamed(path), Is.EqualTo(isIn));
    }
}
