// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.IO;

namespace QuickSes.Tests
{
    public sealed class StructurePreviewTest
    {
        // An alanine (with one hydrogen), a water, twice.
        private const string Model =
            "ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00  0.00           N\n" +
            "ATOM      2  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\n" +
            "ATOM      3  HA  ALA A   1      12.500   6.700  -5.000  1.00  0.00           H\n" +
            "HETATM    4  O   HOH A   2      15.000   6.000  -5.000  1.00  0.00           O\n";
        private const string TwoModels =
            "MODEL        1\n" + Model + "ENDMDL\nMODEL        2\n" + Model + "ENDMDL\nEND\n";

        private string _path;

        [SetUp]
        public void WriteFile()
        {
            _path = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName() + ".pdb");
            File.WriteAllText(_path, TwoModels);
        }

        [TearDown]
        public void DeleteFile() => File.Delete(_path);

        [Test]
        public void AtomsAreCountedAfterFilters()
        {
            var source = new MoleculeSource { SkipWater = true, SkipHydrogen = true, Model = 2 };
            source.SetFile(_path);
            StructurePreview preview = Read(source);
            Assert.That(preview.Error, Is.Empty);
            Assert.That(preview.AtomCount, Is.EqualTo(2));
            Assert.That(preview.FileAtomCount, Is.EqualTo(4));
            Assert.That(preview.Summary, Is.EqualTo("2 of 4 atoms, 1 chain, model 2 of 2 (PDB)"));
            Assert.That(preview.HasPlayableModels, Is.True);
            Assert.That(preview.Warnings, Is.Empty);
        }

        [Test]
        public void TheSameIsReadInTheBackground()
        {
            var source = new MoleculeSource { SkipHydrogen = true };
            source.SetFile(_path);
            StructurePreview preview = InBackground(source);
            Assert.That(preview.Summary, Is.EqualTo(Read(source).Summary));
            source.Selection = "//Z";
            Assert.That(InBackground(source).Error, Is.EqualTo(Read(source).Error));
            source.SetFile(_path + "x");
            Assert.That(InBackground(source).Error, Does.Contain(_path + "x"));
        }

        private static StructurePreview Read(MoleculeSource source)
        {
            if (!source.TryOpen(out Structure structure, out QuickSesError error))
                return StructurePreview.OfError(error);
            using (structure)
                return StructurePreview.Of(structure);
        }

        private static StructurePreview InBackground(MoleculeSource source)
        {
            using (var load = new PreviewLoad(source))
            {
                while (!load.Tick())
                    System.Threading.Thread.Sleep(1);
                Assert.That(load.Progress, Is.EqualTo(1));
                return load.Preview;
            }
        }

        [Test]
        public void WithoutFiltersAllAreThere()
        {
            File.WriteAllText(_path, Model + "END\n");
            var source = new MoleculeSource { SkipWater = false };
            source.SetFile(_path);
            StructurePreview preview = Read(source);
            Assert.That(preview.Summary, Is.EqualTo("4 atoms, 1 chain (PDB)"));
            Assert.That(preview.HasPlayableModels, Is.False);
            File.WriteAllText(_path, Model.Replace(" A ", "   ") + "END\n");
            Assert.That(Read(source).Summary, Is.EqualTo("4 atoms (PDB)"));
        }

        [Test]
        public void ModelsOfMmcifAreNotPlayed()
        {
            File.WriteAllText(_path,
                "data_TWO\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n" +
                "_atom_site.label_atom_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n" +
                "_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n" +
                "_atom_site.pdbx_PDB_model_num\nATOM 1 C CA ALA A 1 0 0 0 1\nATOM 2 C CA ALA A 1 1 0 0 2\n");
            var source = new MoleculeSource { Format = StructureFormat.Mmcif };
            source.SetFile(_path);
            StructurePreview preview = Read(source);
            Assert.That(preview.Summary, Is.EqualTo("1 atom, 1 chain, model 1 of 2 (MMCIF)"));
            Assert.That(preview.HasPlayableModels, Is.False, "a player takes PDB files only");
        }

        [Test]
        public void AFilterThatLeavesNothingIsAnError()
        {
            var source = new MoleculeSource { Selection = "//Z" };
            source.SetFile(_path);
            StructurePreview preview = Read(source);
            Assert.That(preview.Error, Is.Not.Empty);
            Assert.That(preview.Summary, Is.Empty);
        }

        [Test]
        public void AFileThatIsNotThereIsNamed()
        {
            var source = new MoleculeSource();
            source.SetFile(_path + "x");
            Assert.That(Read(source).Error, Does.Contain(_path + "x"));
        }
    }
}
