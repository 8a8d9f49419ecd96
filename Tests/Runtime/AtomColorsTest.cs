// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Text;
using UnityEngine;

namespace QuickSes.Tests
{
    public sealed class AtomColorsTest
    {
        private static readonly Color32 s_uniform = new Color32(1, 2, 3, 255);

        // Atoms in the columns of the PDB format: record, element, residue, chain, number.
        private static Color32[] Colors(AtomColorScheme scheme, params (string, string, string, char, int)[] atoms)
        {
            var text = new StringBuilder();
            for (int i = 0; i < atoms.Length; ++i)
            {
                (string record, string element, string residue, char chain, int number) = atoms[i];
                text.Append(string.Format(CultureInfo.InvariantCulture,
                    "{0,-6}{1,5} {2,2}   {3,3} {4}{5,4}    {6,8:F3}   0.000   0.000  1.00  0.00          {2,2}\n",
                    record, i + 1, element, residue, chain, number, 3.0 * i));
            }
            var source = new MoleculeSource { SkipWater = false };
            source.SetAsset(new TextAsset(text + "END\n") { name = "atoms.pdb" });
            Assert.That(source.TryOpen(out Structure structure, out QuickSesError error), Is.True, error.ToString());
            using (structure)
            {
                Assert.That(structure.AtomCount, Is.EqualTo(atoms.Length));
                var colors = new Color32[atoms.Length + 1]; // more room than needed
                AtomColors.Fill(structure, scheme, s_uniform, colors);
                Assert.That(colors[atoms.Length], Is.EqualTo(default(Color32)));
                Assert.That(colors.Take(atoms.Length).All(color => color.a == 255), Is.True);
                Assert.That(() => AtomColors.Fill(structure, scheme, s_uniform, new Color32[atoms.Length - 1]),
                    Throws.ArgumentException);
                return colors.Take(atoms.Length).ToArray();
            }
        }

        private static Color32 Rgb(int rgb) => new Color32((byte)(rgb >> 16), (byte)(rgb >> 8), (byte)rgb, 255);

        [Test]
        public void UniformIsOneColour() => Assert.That(
            Colors(AtomColorScheme.Uniform, ("ATOM", "C", "ALA", 'A', 1), ("ATOM", "N", "GLY", 'B', 2)),
            Is.EqualTo(new[] { s_uniform, s_uniform }));

        [Test]
        public void ElementsHaveTheColoursOfJmol() => Assert.That(
            Colors(AtomColorScheme.Element, ("ATOM", "C", "ALA", 'A', 1), ("ATOM", "N", "ALA", 'A', 1),
                ("ATOM", "O", "ALA", 'A', 1), ("HETATM", "FE", "HEM", 'A', 2), ("HETATM", "ZN", "ZN", 'A', 3),
                ("ATOM", "S", "CYS", 'A', 4), ("ATOM", "P", "A", 'A', 5)),
            Is.EqualTo(new[]
            {
                Rgb(0x909090), Rgb(0x3050F8), Rgb(0xFF0D0D), Rgb(0xE06633), Rgb(0x7D80B0), Rgb(0xFFFF30), Rgb(0xFF8000)
            }));

        [Test]
        public void ChainsDiffer()
        {
            (string, string, string, char, int)[] atoms = "ABCDEFGHIJKLMNOPA"
                .Select(chain => ("ATOM", "C", "ALA", chain, 1)).ToArray();
            Color32[] colors = Colors(AtomColorScheme.Chain, atoms);
            Assert.That(colors[16], Is.EqualTo(colors[0]));
            for (int i = 0; i < 16; ++i)
                for (int k = 0; k < i; ++k)
                    Assert.That(
                        Mathf.Abs(colors[i].r - colors[k].r) + Mathf.Abs(colors[i].g - colors[k].g) +
                        Mathf.Abs(colors[i].b - colors[k].b), Is.GreaterThan(20), "chains {0} and {1}", i, k);
        }

        [Test]
        public void ResiduesHaveTheColourOfTheirClass()
        {
            Color32[] colors = Colors(AtomColorScheme.Residue, ("ATOM", "C", "ASP", 'A', 1),
                ("ATOM", "C", "GLU", 'A', 2), ("ATOM", "C", "LYS", 'A', 3), ("ATOM", "C", "HID", 'A', 4),
                ("ATOM", "C", "LEU", 'A', 5), ("ATOM", "C", "SER", 'A', 6), ("ATOM", "C", "DA", 'B', 1),
                ("ATOM", "C", "U", 'B', 2), ("HETATM", "O", "HOH", 'A', 7), ("HETATM", "C", "HEM", 'A', 8));
            Assert.That(colors[0], Is.EqualTo(colors[1]));
            Assert.That(colors[2], Is.EqualTo(colors[3]));
            Assert.That(colors[0].r, Is.GreaterThan(2 * colors[0].b)); // red
            Assert.That(colors[2].b, Is.GreaterThan(2 * colors[2].r)); // blue
            Assert.That(colors[8], Is.EqualTo(s_uniform));
            Assert.That(colors[9], Is.EqualTo(s_uniform));
            Assert.That(new[] { 0, 2, 4, 5, 6, 7, 8 }.Select(i => colors[i]).Distinct().Count(), Is.EqualTo(7));
        }

        // Table 2 of Kyte and Doolittle, 1982, from the most hydrophobic to the least.
        private static readonly (string, float)[] s_hydropathy =
        {
            ("ILE", 4.5f), ("VAL", 4.2f), ("LEU", 3.8f), ("PHE", 2.8f), ("CYS", 2.5f), ("MET", 1.9f), ("ALA", 1.8f),
            ("GLY", -0.4f), ("THR", -0.7f), ("SER", -0.8f), ("TRP", -0.9f), ("TYR", -1.3f), ("PRO", -1.6f),
            ("HIS", -3.2f), ("GLU", -3.5f), ("GLN", -3.5f), ("ASP", -3.5f), ("ASN", -3.5f), ("LYS", -3.9f),
            ("ARG", -4.5f)
        };

        [Test]
        public void HydrophobicityGoesFromBlueToRed()
        {
            Color32[] colors = Colors(AtomColorScheme.Hydrophobicity,
                s_hydropathy.Select((entry, i) => ("ATOM", "C", entry.Item1, 'A', i)).ToArray());
            for (int i = 1; i < colors.Length; ++i)
                Assert.That(colors[i].b - colors[i].r, Is.GreaterThanOrEqualTo(colors[i - 1].b - colors[i - 1].r),
                    s_hydropathy[i].Item1);
            Assert.That(colors[0].r - colors[0].b, Is.GreaterThan(200));
            Assert.That(colors[19].b - colors[19].r, Is.GreaterThan(200));
        }

        [Test]
        public void SequenceGoesFromBlueToRedInEachChain()
        {
            var atoms = new List<(string, string, string, char, int)>();
            for (int number = 1; number <= 5; ++number)
                for (int atom = 0; atom < 2; ++atom)
                    atoms.Add(("ATOM", "C", "ALA", 'A', 10 * number));
            atoms.Add(("HETATM", "O", "HOH", 'A', 100));
            atoms.Add(("ATOM", "C", "DA", 'B', 1));
            atoms.Add(("ATOM", "C", "DC", 'B', 2));
            Color32[] colors = Colors(AtomColorScheme.Sequence, atoms.ToArray());
            Assert.That(colors[0].b - colors[0].r, Is.GreaterThan(200));
            Assert.That(colors[9].r - colors[9].b, Is.GreaterThan(200));
            Assert.That(colors[4].g, Is.EqualTo(255)); // midway
            for (int i = 0; i < 10; i += 2)
                Assert.That(colors[i], Is.EqualTo(colors[i + 1]));
            Assert.That(colors.Take(10).Distinct().Count(), Is.EqualTo(5));
            Assert.That(colors[10], Is.EqualTo(s_uniform));
            Assert.That(colors[11], Is.EqualTo(colors[0]));
            Assert.That(colors[12], Is.EqualTo(colors[9]));
        }

        [Test]
        public void UnknownSchemesAreRefused() => Assert.That(
            () => Colors((AtomColorScheme)99, ("ATOM", "C", "ALA", 'A', 1)),
            Throws.TypeOf<System.ArgumentOutOfRangeException>());
    }
}
