// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes;
using System.Collections;
using System.Collections.Generic;
using UMol;
using UnityEngine;
using UnityEngine.TestTools;

/// <summary>Levels 2 and 3 of the page about UnityMol.</summary>
internal sealed class LevelsTest
{
    private static readonly Color32 s_red = new Color32(255, 0, 0, 255);
    private static readonly Color32 s_blue = new Color32(0, 0, 255, 255);

    [Test]
    public void OneMeshStaysAndHasTheColoursOfAtoms()
    {
        UnityMolSelection selection = Selections.Blob(60, 1);
        Vector3[] positions = Selections.Positions(selection);
        float[] radii = Selections.Radii(selection);
        Color32[] colors = Alternating(60);
        using var surface = new SelectionMesh();
        Mesh mesh = surface.mesh;
        for (int frame = 0; frame < 3; ++frame)
        {
            positions[0].x += 1;
            Assert.That(surface.Compute(positions, radii, colors, null, 60, 1, 1.4f), Is.Empty);
            Assert.That(surface.mesh, Is.SameAs(mesh));
            AssertColours(mesh, surface.atomByVert, colors);
            Assert.That(mesh.normals[0].magnitude, Is.EqualTo(1).Within(1e-4));
        }
    }

    [Test]
    public void HiddenAtomsHaveNoTriangles()
    {
        UnityMolSelection selection = Selections.Blob(60, 2);
        Vector3[] positions = Selections.Positions(selection);
        float[] radii = Selections.Radii(selection);
        Color32[] colors = Alternating(60);
        using var surface = new SelectionMesh();
        Assert.That(surface.Compute(positions, radii, colors, null, 60, 1, 1.4f), Is.Empty);
        int all = surface.mesh.triangles.Length;
        var visible = new byte[70]; // a capacity, as the other arrays
        for (int i = 0; i < 30; ++i)
            visible[i] = 1;
        Assert.That(surface.Compute(positions, radii, colors, visible, 60, 1, 1.4f), Is.Empty);
        Assert.That(surface.mesh.triangles.Length, Is.InRange(3, all - 3));
        foreach (int vertex in surface.mesh.triangles)
            Assert.That(surface.atomByVert[vertex], Is.LessThan(30));
    }

    [Test]
    public void AFailureLeavesAnEmptyMesh()
    {
        var positions = new[] { Vector3.zero };
        var radii = new[] { 1.5f };
        using var surface = new SelectionMesh();
        Assert.That(surface.Compute(positions, radii, Alternating(1), null, 1, 1, 1.4f), Is.Empty);
        positions[0].z = float.NaN;
        Assert.That(surface.Compute(positions, radii, Alternating(1), null, 1, 1, 1.4f), Is.Not.Empty);
        Assert.That(surface.mesh.vertexCount, Is.EqualTo(0));
    }

    [UnityTest]
    public IEnumerator AComponentFollowsFramesOfTheWholeStructure()
    {
        UnityMolSelection structure = Selections.Blob(80, 3);
        UnityMolSelection selection = Selections.Of(structure.atoms.GetRange(20, 40).ToArray());
        var show = new SelectionSurface(new GameObject(), selection, null, 1.4f);
        show.surface.Spacing = 1;
        show.SetColors(Alternating(40));
        yield return Settle(show.surface);
        Assert.That(show.surface.Mesh.vertexCount,
            Is.EqualTo(show.surface.CurrentLevel.VertexCount).And.GreaterThan(100));
        AssertColours(show.surface.Mesh, System.Array.ConvertAll(show.surface.Owners.ToArray(), atom => (int)atom),
            Alternating(40));

        Vector3 before = show.surface.Mesh.bounds.center;
        Vector3[] frame = System.Array.ConvertAll(Selections.Positions(structure), place => place + Vector3.up * 50);
        show.ShowFrame(frame);
        yield return Settle(show.surface);
        Assert.That((show.surface.Mesh.bounds.center - before - Vector3.up * 50).magnitude, Is.LessThan(0.5f));

        Vector3 center = show.surface.Mesh.bounds.center;
        UnityMolAtom atom = show.AtomUnder(new Ray(center - Vector3.forward * 100, Vector3.forward));
        Assert.That(selection.atoms, Does.Contain(atom));

        uint indices = show.surface.Mesh.GetIndexCount(0);
        show.Show(new HashSet<UnityMolAtom>(selection.atoms.GetRange(0, 20)));
        yield return Settle(show.surface);
        Assert.That(show.surface.Mesh.GetIndexCount(0), Is.InRange(1, indices - 1));
    }

    private static Color32[] Alternating(int count)
    {
        var colors = new Color32[count];
        for (int i = 0; i < count; ++i)
            colors[i] = i % 2 == 0 ? s_red : s_blue;
        return colors;
    }

    private static void AssertColours(Mesh mesh, int[] owners, Color32[] ofAtoms)
    {
        Color32[] shown = mesh.colors32;
        Assert.That(shown.Length, Is.EqualTo(mesh.vertexCount).And.GreaterThan(10));
        for (int v = 0; v < shown.Length; ++v)
            Assert.That(shown[v], Is.EqualTo(ofAtoms[owners[v]]));
    }

    internal const double Patience = 150; // s

    internal static IEnumerator Settle(MolecularSurface surface)
    {
        var clock = System.Diagnostics.Stopwatch.StartNew();
        do
        {
            Assert.That(clock.Elapsed.TotalSeconds, Is.LessThan(Patience), "still waiting");
            yield return null;
        } while (surface.IsBusy);
    }
}
