// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;

namespace QuickSes.Tests
{
    public sealed class MoleculeNamesTest
    {
        [TestCase("/data/1crn.pdb", "1crn")]
        [TestCase("ensembles/2k39.PDB.gz.bytes", "2k39")]
        [TestCase("2k39.pdb", "2k39")] // a text asset's name
        [TestCase("my.protein.v2.cif", "my.protein.v2")]
        [TestCase("protein", "protein")]
        [TestCase("", "Molecular Surface")]
        [TestCase(null, "Molecular Surface")]
        [TestCase(".pdb", "Molecular Surface")]
        public void ObjectsAreCalledAsTheirFile(string file, string name) =>
            Assert.That(MoleculeNames.ObjectNameOf(file), Is.EqualTo(name));

        [TestCase("1crn", "1crn")]
        [TestCase(" chain A/B: \"x\"? ", "chain A_B_ _x__")]
        [TestCase(".hidden", "_hidden")] // Unity takes no file of that name
        [TestCase("", "Molecular Surface")]
        [TestCase(null, "Molecular Surface")]
        public void AssetsAreCalledAsTheirObjectWithoutWhatFileSystemsRefuse(string objectName, string name) =>
            Assert.That(MoleculeNames.AssetNameOf(objectName), Is.EqualTo(name));

        [Test]
        public void WhatAPrefabNeedsLiesBesideIt()
        {
            const string path = "Assets/My.folder/protein.v2.prefab";
            Assert.That(MoleculeNames.MeshBeside(path), Is.EqualTo("Assets/My.folder/protein.v2 mesh.asset"));
            Assert.That(MoleculeNames.MaterialBeside(path, 0), Is.EqualTo("Assets/My.folder/protein.v2 material.mat"));
            Assert.That(MoleculeNames.MaterialBeside(path, 1), Is.EqualTo("Assets/My.folder/protein.v2 material 2.mat"));
        }
    }
}
