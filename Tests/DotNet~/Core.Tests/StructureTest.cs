// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;

namespace QuickSes.Tests
{
    public sealed class StructureTest
    {
        // Columns of the PDB format.
        private static List<string> AtomLines() =>
            File.ReadLines(Repository.CrambinPath).Where(line =>
                line.StartsWith("ATOM  ") || line.StartsWith("HETATM")).ToList();

        private static float Column(string line, int start, int length) =>
            float.Parse(line.Substring(start, length), CultureInfo.InvariantCulture);

        private static Structure Open(StructureOptions options)
        {
            Assert.That(
                Structure.TryOpen(Repository.CrambinPath, options, out Structure structure, out QuickSesError error),
                Is.True, error.ToString());
            return structure;
        }

        [Test]
        public void FilesAreReadUpToALimit()
        {
            long size = new FileInfo(Repository.CrambinPath).Length;
            try
            {
                InputLimit.Set(size - 1);
                Assert.That(
                    Structure.TryOpen(Repository.CrambinPath, default, out _, out QuickSesError error), Is.False);
                Assert.That(error.Status, Is.EqualTo(QuickSesStatus.FileError));
                InputLimit.Set(size);
                Open(default).Dispose();
            }
            finally
            {
                InputLimit.Set(0);
            }
            Assert.That(() => InputLimit.Set(-1), Throws.TypeOf<ArgumentOutOfRangeException>());
        }

        [Test]
        public void AtomsHaveColours()
        {
            byte[] uniform = { 1, 2, 3, 4 };
            Structure structure = Open(default);
            var rgba = new byte[4 * structure.AtomCount + 4]; // more room than needed
            structure.FillColors(AtomColorScheme.Uniform, uniform, rgba);
            Assert.That(rgba.Take(4 * structure.AtomCount).Select((value, i) => value == 1 + i % 4), Has.All.True);
            Assert.That(rgba.Skip(4 * structure.AtomCount), Is.All.EqualTo(0));
            structure.FillColors(AtomColorScheme.Element, uniform, rgba);
            Assert.That(rgba.Take(8), Is.EqualTo(new byte[] { 0x30, 0x50, 0xF8, 255, 0x90, 0x90, 0x90, 255 })); // N, C
            Assert.That(() => structure.FillColors((AtomColorScheme)6, uniform, rgba),
                Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => structure.FillColors(AtomColorScheme.Chain, new byte[3], rgba), Throws.ArgumentException);
            Assert.That(() => structure.FillColors(AtomColorScheme.Chain, uniform, new byte[4 * structure.AtomCount - 1]),
                Throws.ArgumentException);
            structure.Dispose();
            Assert.That(() => structure.FillColors(AtomColorScheme.Chain, uniform, rgba),
                Throws.TypeOf<ObjectDisposedException>());
        }

        [Test]
        public void AtomsAreThoseOfTheFile()
        {
            List<string> lines = AtomLines();
            using Structure structure = Open(default);
            Assert.That(structure.AtomCount, Is.EqualTo(lines.Count));
            Assert.That(structure.FileAtomCount, Is.EqualTo(lines.Count));
            Assert.That((structure.Format, structure.Model, structure.ModelCount),
                Is.EqualTo((StructureFormat.Pdb, 1, 1)));
            for (int i = 0; i < lines.Count; ++i)
            {
                for (int d = 0; d < 3; ++d)
                    Assert.That(structure.Positions[3 * i + d], Is.EqualTo(Column(lines[i], 30 + 8 * d, 8)));
                StructureAtom atom = structure.GetAtom(i);
                Assert.That(atom.Name, Is.EqualTo(lines[i].Substring(12, 4).Trim()));
                Assert.That(atom.ResidueName, Is.EqualTo(lines[i].Substring(17, 3).Trim()));
                Assert.That(atom.Chain, Is.EqualTo(lines[i].Substring(21, 1)));
                Assert.That(atom.ResidueNumber, Is.EqualTo(int.Parse(lines[i].Substring(22, 4))));
                Assert.That(structure.FileIndices[i], Is.EqualTo((uint)i));
                Assert.That(atom.InsertionCode, Is.EqualTo(' '));
                Assert.That(atom.IsWater || atom.IsHetero || atom.IsHydrogen, Is.False);
                string symbol = lines[i].Substring(76, 2).Trim();
                int element = new Dictionary<string, int> { ["C"] = 6, ["N"] = 7, ["O"] = 8, ["S"] = 16 }[symbol];
                Assert.That((int)atom.Element, Is.EqualTo(element));
                Assert.That((int)structure.FileElements[i], Is.EqualTo(element));
                Assert.That(structure.Radii[i],
                    Is.EqualTo(element switch { 6 => 1.70f, 7 => 1.55f, 8 => 1.52f, _ => 1.80f }));
            }
            Assert.That(() => structure.GetAtom(lines.Count), Throws.TypeOf<ArgumentOutOfRangeException>());
        }

        [Test]
        public void MemoryAndFileAreTheSame()
        {
            using Structure fromFile = Open(default);
            Assert.That(Structure.TryOpen(File.ReadAllBytes(Repository.CrambinPath),
                new StructureOptions { Format = StructureFormat.Pdb }, out Structure fromMemory, out _), Is.True);
            using (fromMemory)
            {
                Assert.That(fromMemory.Positions.SequenceEqual(fromFile.Positions), Is.True);
                Assert.That(fromMemory.Radii.SequenceEqual(fromFile.Radii), Is.True);
            }
        }

        [Test]
        public void OptionsReachTheReader()
        {
            using Structure few = Open(new StructureOptions { Selection = "//A/3-10" });
            int[] expected = AtomLines().Select((line, i) => (Number: int.Parse(line.Substring(22, 4)), i))
                .Where(pair => pair.Number >= 3 && pair.Number <= 10).Select(pair => pair.i).ToArray();
            Assert.That(few.FileIndices.ToArray(), Is.EqualTo(expected));

            string water = "HETATM    1  O   HOH A   1       0.000   0.000   0.000  1.00  0.00           O\n" +
                           "ATOM      2  N   GLY A   2       9.000   0.000   0.000  1.00  0.00           N\n" +
                           "ATOM      3  H   GLY A   2      10.000   0.000   0.000  1.00  0.00           H\n" +
                           "HETATM    4 ZN    ZN A   3      20.000   0.000   0.000  1.00  0.00          ZN\nEND\n";
            byte[] bytes = System.Text.Encoding.ASCII.GetBytes(water);
            uint[] Kept(StructureOptions options)
            {
                options.Format = StructureFormat.Pdb;
                Assert.That(Structure.TryOpen(bytes, options, out Structure structure, out QuickSesError error),
                    Is.True, error.ToString());
                using (structure)
                    return structure.FileIndices.ToArray();
            }
            Assert.That(Kept(default), Is.EqualTo(new uint[] { 0, 1, 2, 3 }));
            Assert.That(Kept(new StructureOptions { SkipWater = true }), Is.EqualTo(new uint[] { 1, 2, 3 }));
            Assert.That(Kept(new StructureOptions { SkipHetero = true }), Is.EqualTo(new uint[] { 1, 2 }));
            Assert.That(Kept(new StructureOptions { SkipHydrogen = true }), Is.EqualTo(new uint[] { 0, 1, 3 }));
        }

        [TestCase("")]
        [TestCase("//A/3-10")]
        [TestCase("//A/3-10/CA[C]")]
        [TestCase("(!ALA,GLY)")]
        [TestCase("//Z")]
        public void SelectionsNameWhatTheFilterKeeps(string selection)
        {
            using Structure all = Open(default);
            int[] indices = all.Select(selection);
            var mask = new bool[all.AtomCount];
            Assert.That(all.TrySelect(selection, mask, out int count, out QuickSesError error), Is.True, error.ToString());
            Assert.That(count, Is.EqualTo(indices.Length));
            Assert.That(Enumerable.Range(0, mask.Length).Where(i => mask[i]), Is.EqualTo(indices));
            if (Structure.TryOpen(Repository.CrambinPath, new StructureOptions { Selection = selection },
                out Structure some, out _))
                using (some)
                    Assert.That(some.FileIndices.ToArray().Select(i => (int)i), Is.EqualTo(indices));
            else
                Assert.That(indices, Is.Empty);
        }

        [Test]
        public void SelectingMakesNoGarbage()
        {
            using Structure all = Open(default);
            var mask = new bool[all.AtomCount];
            all.TrySelect("//A/3-10", mask, out _, out _);
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int k = 0; k < 100; ++k)
                all.TrySelect("//A/3-10", mask, out _, out _);
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.EqualTo(0));
        }

        [Test]
        public void SelectionsThatAreWrongAreNamed()
        {
            using Structure all = Open(default);
            var mask = new bool[all.AtomCount];
            mask[5] = true;
            foreach (int length in new[] { 5, 255, 256, 257, 500 }) // 256 with a zero behind it fit on the stack
            {
                string wrong = "//[[".PadRight(length - 1, 'x') + "y", end = wrong.Substring(Math.Max(0, length - 90));
                Assert.That(all.TrySelect(wrong, mask, out int count, out QuickSesError error), Is.False);
                Assert.That((error.Status, count, mask[5]), Is.EqualTo((QuickSesStatus.InvalidArgument, 0, true)));
                Assert.That(error.Message, Does.Contain("'//[[").And.Contain(end + "'")); // of a long one the two ends
            }
            QuickSesException thrown = Assert.Throws<QuickSesException>(() => all.Select("//[["));
            Assert.That(thrown.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(() => all.Select(null), Throws.ArgumentNullException);
            Assert.That(() => all.Select("a\0b"), Throws.ArgumentException);
            Assert.That(() => all.TrySelect("", new bool[3], out _, out _), Throws.ArgumentException);
            all.Dispose();
            Assert.That(() => all.Select(""), Throws.TypeOf<ObjectDisposedException>());
        }

        [Test]
        public void AtomsSayWhatTheyAre()
        {
            using Structure all = Open(default);
            Assert.That(all.GetAtom(1).ToString(), Is.EqualTo("CA of THR 1, chain A"));
            byte[] inserted = System.Text.Encoding.ASCII.GetBytes(
                "ATOM      1  N   GLY    -2C      9.000   0.000   0.000  1.00  0.00           N\n");
            Assert.That(Structure.TryOpen(inserted, new StructureOptions { Format = StructureFormat.Pdb },
                out Structure structure, out _), Is.True);
            using (structure)
                Assert.That(structure.GetAtom(0).ToString(), Is.EqualTo("N of GLY -2C"));
            byte[] lone = System.Text.Encoding.ASCII.GetBytes(
                "ATOM      1  N           2       9.000   0.000   0.000  1.00  0.00           N\n");
            Assert.That(Structure.TryOpen(lone, new StructureOptions { Format = StructureFormat.Pdb },
                out structure, out _), Is.True);
            using (structure)
                Assert.That(structure.GetAtom(0).ToString(), Is.EqualTo("N of 2"), "a residue may have no name");
            byte[] nameless = System.Text.Encoding.ASCII.GetBytes("0 0 0 1.5\n");
            Assert.That(Structure.TryOpen(nameless, new StructureOptions { Format = StructureFormat.Xyzr },
                out structure, out _), Is.True);
            using (structure)
                Assert.That(structure.GetAtom(0).ToString(), Is.Empty);
        }

        [Test]
        public void ResiduesAndMemory()
        {
            using Structure all = Open(default);
            for (int i = 1; i < all.AtomCount; ++i)
                Assert.That(all.Residues[i] - all.Residues[i - 1],
                    Is.EqualTo(all.GetAtom(i).ResidueNumber - all.GetAtom(i - 1).ResidueNumber));
            Assert.That(all.MemoryBytes, Is.InRange(50 * all.AtomCount, 1000 * all.AtomCount));
        }

        [Test]
        public void RadiiAreReadFromAFile()
        {
            using var folder = new TemporaryFolder();
            File.WriteAllText(folder.File("rädii.txt"), "C 2.5\n* 1.25\n");
            using Structure structure = Open(new StructureOptions { Radii = folder.File("rädii.txt") });
            for (int i = 0; i < structure.AtomCount; ++i)
                Assert.That(structure.Radii[i], Is.EqualTo(structure.GetAtom(i).Element == 6 ? 2.5f : 1.25f));
        }

        [Test]
        public void AssembliesAndLocationsReachTheReader()
        {
            string text = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n" +
                          "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n" +
                          "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n" +
                          "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n" +
                          "REMARK 350   BIOMT1   2  1.000000  0.000000  0.000000       10.00000\n" +
                          "REMARK 350   BIOMT2   2  0.000000  1.000000  0.000000        0.00000\n" +
                          "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        0.00000\n" +
                          "ATOM      1  CA AGLY A   1       1.000   0.000   0.000  0.40  0.00           C\n" +
                          "ATOM      2  CA BGLY A   1       2.000   0.000   0.000  0.60  0.00           C\nEND\n";
            byte[] bytes = System.Text.Encoding.ASCII.GetBytes(text);
            float[] Places(StructureOptions options)
            {
                options.Format = StructureFormat.Pdb;
                Assert.That(Structure.TryOpen(bytes, options, out Structure structure, out QuickSesError error),
                    Is.True, error.ToString());
                using (structure)
                    return structure.Positions.ToArray().Where((x, i) => i % 3 == 0).ToArray();
            }
            Assert.That(Places(default), Is.EqualTo(new[] { 1f }));
            Assert.That(Places(new StructureOptions { AlternateLocation = "highest" }), Is.EqualTo(new[] { 2f }));
            Assert.That(Places(new StructureOptions { Assembly = "1" }), Is.EqualTo(new[] { 1f, 11f }));
            var copy = new StructureOptions { Assembly = "1", AlternateLocation = "B", Selection = "chain A2" };
            Assert.That(Places(copy), Is.EqualTo(new[] { 12f }));
            Assert.That(Structure.TryOpen(bytes, new StructureOptions { Format = StructureFormat.Pdb, Assembly = "9" },
                out _, out QuickSesError unknown), Is.False);
            Assert.That(unknown.Message, Does.Contain("there is 1"));
        }

        [TestCase("protein and chain A", 327)]
        [TestCase("resid 3-10 and name CA", 8)]
        [TestCase("water", 0)]
        public void SelectionsMayBeWords(string selection, int count)
        {
            using Structure all = Open(default);
            Assert.That(all.Select(selection).Length, Is.EqualTo(count));
        }

        [Test]
        public void PathsAreUtf8()
        {
            using var folder = new TemporaryFolder();
            string path = folder.File("Krambin 溶媒 ü.pdb");
            File.Copy(Repository.CrambinPath, path);
            Assert.That(Structure.TryOpen(path, default, out Structure structure, out QuickSesError error), Is.True,
                error.ToString());
            structure.Dispose();
        }

        [Test]
        public void FaultsAreNamed()
        {
            bool Opens(string path, StructureOptions options, out QuickSesError error)
            {
                bool opened = Structure.TryOpen(path, options, out Structure structure, out error);
                structure?.Dispose();
                return opened;
            }
            Assert.That(Opens("/no/such/file.pdb", default, out QuickSesError fault), Is.False);
            Assert.That(fault.Status, Is.EqualTo(QuickSesStatus.FileError));
            Assert.That(fault.Message, Does.Contain("/no/such/file.pdb"));
            Assert.That(Opens(Repository.CrambinPath, new StructureOptions { Model = 2 }, out fault), Is.False);
            Assert.That(fault.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(fault.Message, Does.Contain("model"));
            Assert.That(Structure.TryOpen(ReadOnlySpan<byte>.Empty, default, out _, out fault), Is.False);
            Assert.That(fault.Status, Is.EqualTo(QuickSesStatus.FileError));
            Assert.That(() => Opens(null, default, out _), Throws.ArgumentNullException);
            Assert.That(() => Opens("a\0b", default, out _), Throws.ArgumentException);

            Structure closed = Open(default);
            closed.Dispose();
            closed.Dispose();
            Assert.That(() => closed.Positions.Length, Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => closed.GetAtom(0), Throws.TypeOf<ObjectDisposedException>());
        }
    }
}
