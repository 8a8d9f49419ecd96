// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>
    /// Amino acids of proteins are L, and stay so in Unity. The CORN rule: seen with H of the alpha carbon towards the
    /// viewer, CO, R and N follow each other clockwise.
    /// </summary>
    public sealed class ChiralityTest
    {
        // Residues 1 to 4 of crambin, entry 1CRN of the Protein Data Bank (public domain).
        private const string Peptide =
            "ATOM      1  N   THR A   1      17.047  14.099   3.625  1.00 13.79           N\n" +
            "ATOM      2  CA  THR A   1      16.967  12.784   4.338  1.00 10.80           C\n" +
            "ATOM      3  C   THR A   1      15.685  12.755   5.133  1.00  9.19           C\n" +
            "ATOM      5  CB  THR A   1      18.170  12.703   5.337  1.00 13.02           C\n" +
            "ATOM      8  N   THR A   2      15.115  11.555   5.265  1.00  7.81           N\n" +
            "ATOM      9  CA  THR A   2      13.856  11.469   6.066  1.00  8.31           C\n" +
            "ATOM     10  C   THR A   2      14.164  10.785   7.379  1.00  5.80           C\n" +
            "ATOM     12  CB  THR A   2      12.732  10.711   5.261  1.00 10.32           C\n" +
            "ATOM     15  N   CYS A   3      13.488  11.241   8.417  1.00  5.24           N\n" +
            "ATOM     16  CA  CYS A   3      13.660  10.707   9.787  1.00  5.39           C\n" +
            "ATOM     17  C   CYS A   3      12.269  10.431  10.323  1.00  4.45           C\n" +
            "ATOM     19  CB  CYS A   3      14.368  11.748  10.691  1.00  5.99           C\n" +
            "ATOM     21  N   CYS A   4      12.019   9.272  10.928  1.00  3.90           N\n" +
            "ATOM     22  CA  CYS A   4      10.646   8.991  11.408  1.00  4.24           C\n" +
            "ATOM     23  C   CYS A   4      10.654   8.793  12.919  1.00  3.72           C\n" +
            "ATOM     25  CB  CYS A   4      10.057   7.752  10.682  1.00  4.41           C\n" +
            "END\n";
        private const int ResidueCount = 4;

        private static readonly string[] s_names = { "N", "CA", "C", "CB" };

        private static Structure Open()
        {
            var source = new MoleculeSource();
            source.SetAsset(new TextAsset(Peptide) { name = "peptide.pdb" });
            Assert.That(source.TryOpen(out Structure structure, out QuickSesError error), Is.True, error.ToString());
            for (int i = 0; i < 4 * ResidueCount; ++i)
                Assert.That(structure.GetAtom(i).Name, Is.EqualTo(s_names[i % 4]));
            return structure;
        }

        // Whether it is L to a viewer in Unity, where a camera's right is Cross(up, forward) in Unity's numbers: that
        // is x for the up y and forward z of the world's axes.
        private static bool IsSeenAsL(Vector3 n, Vector3 ca, Vector3 c, Vector3 cb)
        {
            Vector3 towardsH = -((n - ca).normalized + (c - ca).normalized + (cb - ca).normalized).normalized;
            Vector3 forward = -towardsH;
            Vector3 up = Vector3.Cross(forward, new Vector3(0.3f, 0.5f, 0.8f)).normalized;
            Vector3 right = Vector3.Cross(up, forward);
            Vector2 OnScreen(Vector3 atom) => new Vector2(Vector3.Dot(atom - ca, right), Vector3.Dot(atom - ca, up));
            Vector2 co = OnScreen(c), r = OnScreen(cb), nitrogen = OnScreen(n);
            float area = (r.x - co.x) * (nitrogen.y - co.y) - (r.y - co.y) * (nitrogen.x - co.x);
            return area < 0; // counter-clockwise is positive where x is right and y is up
        }

        // (N - CA) x (C - CA) . (CB - CA): in right-handed numbers positive for L. With H up, seen from above, CO at 90
        // degrees, R at -30 and N at 210 (clockwise), all a bit below CA, it is the product of such vectors.
        private static float Triple(Vector3 n, Vector3 ca, Vector3 c, Vector3 cb) =>
            Vector3.Dot(Vector3.Cross(n - ca, c - ca), cb - ca);

        private static IEnumerable<Vector3[]> Residues(Vector3[] positions)
        {
            Assert.That(positions.Length, Is.EqualTo(4 * ResidueCount));
            for (int k = 0; k < ResidueCount; ++k)
                yield return new[]
                    { positions[4 * k], positions[4 * k + 1], positions[4 * k + 2], positions[4 * k + 3] };
        }

        [Test]
        public void CameraOfTheTestIsUnitys() => Assert.That(
            Vector3.Cross(Vector3.up, Vector3.forward), Is.EqualTo(Vector3.right));

        [Test]
        public void SignsOfTheTripleProductAreThoseOfTheRule()
        {
            Vector3 At(float degrees) => new Vector3(
                Mathf.Cos(degrees * Mathf.Deg2Rad), Mathf.Sin(degrees * Mathf.Deg2Rad), -0.3f);
            Assert.That(Triple(At(210), Vector3.zero, At(90), At(-30)), Is.GreaterThan(0)); // N, C, CB
        }

        [Test]
        public void FilesHoldLAminoAcids()
        {
            using (Structure structure = Open())
            {
                var xyz = new Vector3[structure.AtomCount];
                for (int i = 0; i < xyz.Length; ++i)
                    xyz[i] = new Vector3(structure.Positions[3 * i], structure.Positions[3 * i + 1],
                        structure.Positions[3 * i + 2]);
                foreach (Vector3[] residue in Residues(xyz))
                    Assert.That(Triple(residue[0], residue[1], residue[2], residue[3]), Is.GreaterThan(1));
                // The control: numbers of a file taken as Unity's show the mirror image.
                foreach (Vector3[] residue in Residues(xyz))
                    Assert.That(IsSeenAsL(residue[0], residue[1], residue[2], residue[3]), Is.False);
            }
        }

        [Test]
        public void LoadedAminoAcidsAreSeenAsL()
        {
            var molecule = new GameObject("peptide");
            try
            {
                var surface = molecule.AddComponent<MolecularSurface>();
                surface.Source.SetAsset(new TextAsset(Peptide) { name = "peptide.pdb" });
                Assert.That(surface.LoadSource(), Is.True);
                foreach (Vector3[] residue in Residues(surface.Positions.ToArray()))
                {
                    Assert.That(IsSeenAsL(residue[0], residue[1], residue[2], residue[3]), Is.True);
                    Assert.That(Triple(residue[0], residue[1], residue[2], residue[3]), Is.LessThan(-1));
                }
            }
            finally
            {
                Object.DestroyImmediate(molecule);
            }
        }

        [Test]
        public void PlayedAminoAcidsAreSeenAsL()
        {
            using (var playing = new PlayerFixture())
            {
                playing.Player.StructureSource.SetAsset(new TextAsset(
                    $"MODEL        1\n{Peptide.Replace("END", "ENDMDL")}MODEL        2\n" +
                    $"{Peptide.Replace("END", "ENDMDL")}END\n") { name = "two.pdb" });
                playing.Load();
                playing.Player.Frame = 1;
                playing.WaitUntilShown(1);
                foreach (Vector3[] residue in Residues(playing.Positions))
                    Assert.That(IsSeenAsL(residue[0], residue[1], residue[2], residue[3]), Is.True);
            }
        }

        [Test]
        public void ThereAndBackIsTheSame()
        {
            float[] xyz = { 1, 2, 3, -4, 5, -6 };
            var positions = new Vector3[2];
            UnitySpace.FromFile(xyz, positions);
            Assert.That(positions, Is.EqualTo(new[] { new Vector3(-1, 2, 3), new Vector3(4, 5, -6) }));
            Assert.That(UnitySpace.FromFile(1, 2, 3), Is.EqualTo(positions[0]));
            var back = new float[6];
            UnitySpace.ToFile(positions, back);
            Assert.That(back, Is.EqualTo(xyz));
            UnitySpace.FromFile(xyz, new uint[] { 1 }, positions);
            Assert.That(positions[0], Is.EqualTo(new Vector3(4, 5, -6)));
            Assert.That(() => UnitySpace.FromFile(new float[4], new Vector3[2]), Throws.ArgumentException);
            Assert.That(() => UnitySpace.FromFile(xyz, new Vector3[1]), Throws.ArgumentException);
            Assert.That(() => UnitySpace.FromFile(xyz, new uint[2], new Vector3[1]), Throws.ArgumentException);
            Assert.That(() => UnitySpace.ToFile(positions, new float[5]), Throws.ArgumentException);
        }
    }
}
