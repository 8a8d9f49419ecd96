// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System;
using System.Collections;
using System.IO;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Files of molecules in Assets.</summary>
    public sealed class MoleculeImporterTest
    {
        private const string Folder = "Assets/QuickSes importer test";
        private const int MostFrames = 100000;
        private const string Pdb =
            "ATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\n";

        private readonly CreatedSurfaces _created = new CreatedSurfaces();

        [SetUp]
        public void MakeFolder() => AssetDatabase.CreateFolder("Assets", Path.GetFileName(Folder));

        [TearDown]
        public void Delete()
        {
            _created.Destroy();
            AssetDatabase.DeleteAsset(Folder);
        }

        private static MoleculeAsset Import(string name, string text)
        {
            string path = Folder + "/" + name;
            File.WriteAllText(path, text);
            AssetDatabase.ImportAsset(path, ImportAssetOptions.ForceSynchronousImport);
            AssetDatabase.Refresh();
            return AssetDatabase.LoadAssetAtPath<MoleculeAsset>(path);
        }

        [Test]
        public void EachOfItsExtensionsTellsAFormat()
        {
            var attribute = (ScriptedImporterAttribute)Attribute.GetCustomAttribute(
                typeof(MoleculeImporter), typeof(ScriptedImporterAttribute));
            foreach (string extension in attribute.fileExtensions)
                Assert.That(MoleculeFile.StructureFormatOf("a." + extension) != StructureFormat.Auto ||
                    MoleculeFiles.IsTrajectory("a." + extension), Is.True, extension);
        }

        [Test]
        public void StructuresAreAssetsThatSurfacesRead([Values("a.pdb", "a.ent")] string name)
        {
            MoleculeAsset asset = Import(name, Pdb);
            Assert.That(asset != null, Is.True);
            Assert.That(asset.FileName, Is.EqualTo(name));
            Assert.That(asset.Size, Is.EqualTo(Pdb.Length));
            var source = new MoleculeSource();
            source.SetAsset(asset);
            MolecularSurface surface = _created.Keep(SurfaceCreator.Create(source, null));
            Assert.That(surface.name, Is.EqualTo("a"));
            Assert.That(surface.LoadSource(), Is.True, surface.LastError.Message);
            Assert.That(surface.AtomCount, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator WhatIsImportedAnewIsShown()
        {
            var source = new MoleculeSource();
            source.SetAsset(Import("a.pdb", Pdb));
            MolecularSurface surface = _created.Keep(SurfaceCreator.Create(source, null));
            Assert.That(surface.LoadSource(), Is.True, surface.LastError.Message);
            Assert.That(surface.AtomCount, Is.EqualTo(1));
            Import("a.pdb", Pdb + Pdb.Replace("ALA A   1      11", "ALA A   2      15"));
            for (int frame = 0; frame < MostFrames && surface.AtomCount != 2; ++frame)
                yield return null;
            Assert.That(surface.AtomCount, Is.EqualTo(2));
        }

        // The new bytes are in an array of their own, also where there are as many: other threads may be at those before.
        [Test]
        public void WhatIsImportedAnewLeavesTheBytesBefore()
        {
            var source = new MoleculeSource();
            source.SetAsset(Import("a.pdb", Pdb));
            MoleculeSource before = source.Copy();
            Import("a.pdb", Pdb.Replace("11.639", "12.639"));
            Assert.That(before.IsSameAs(source), Is.False);
            Assert.That(XOfFirstAtom(before), Is.EqualTo(11.639f));
            Assert.That(XOfFirstAtom(source), Is.EqualTo(12.639f));
        }

        private static float XOfFirstAtom(MoleculeSource source)
        {
            Assert.That(source.TryOpen(out Structure structure, out QuickSesError error), Is.True, error.Message);
            using (structure)
                return structure.Positions[0];
        }

        [Test]
        public void DebugDatabasesStayWithUnity()
        {
            Assert.That(Import("library.pdb", "Microsoft C/C++ MSF 7.00\r\n") == null, Is.True);
            Assert.That(AssetDatabase.GetImporterOverride(Folder + "/library.pdb"), Is.Null);
        }

        [Test]
        public void AFileThatIsChosenInAssetsIsReferredToAsAsset()
        {
            Import("b.pdb", Pdb);
            ChosenFile chosen = ChosenFile.Of(Path.GetFullPath(Folder + "/b.pdb"));
            Assert.That(chosen.Kind, Is.EqualTo(MoleculeSourceKind.MoleculeAsset));
            Assert.That(chosen.Asset, Is.TypeOf<MoleculeAsset>());
            Assert.That(ChosenFile.TryTake(chosen.Asset, out ChosenFile dragged), Is.True);
            Assert.That(dragged.Kind, Is.EqualTo(MoleculeSourceKind.MoleculeAsset));
            var script = new GameObject("drop").AddComponent<MolecularSurface>();
            _created.Keep(script);
            var serialized = new SerializedObject(script);
            dragged.AssignTo(serialized.FindProperty("_source"));
            serialized.ApplyModifiedProperties();
            Assert.That(script.Source.Kind, Is.EqualTo(MoleculeSourceKind.MoleculeAsset));
            Assert.That(script.Source.Molecule, Is.SameAs(chosen.Asset));
            Assert.That(ChosenFile.TryTake(script.gameObject, out _), Is.False);
        }
    }
}
