// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes;
using System;
using System.Collections;
using System.IO;
using UnityEngine;
using UnityEngine.TestTools;

/// <summary>The scripts of the page about Unity do what it says of them.</summary>
internal sealed class UnityPageTest
{
    [UnityTest]
    public IEnumerator TheFirstScriptShowsTwoAtomsThatMove()
    {
        var owner = new GameObject();
        owner.AddComponent<TwoAtoms>();
        yield return null;
        var surface = owner.GetComponent<MolecularSurface>();
        yield return Until(() => surface.CurrentLevel.VertexCount > 0);
        Mesh mesh = owner.GetComponent<MeshFilter>().sharedMesh;
        Assert.That(mesh, Is.SameAs(surface.Mesh));
        Assert.That(surface.Owners.ToArray(), Has.Some.EqualTo(0u).And.Some.EqualTo(1u));
        Assert.That(mesh.bounds.min.x, Is.EqualTo(-1.7f).Within(0.05), "1 unit is 1 Å");
        Assert.That(mesh.colors32, Is.All.EqualTo(surface.BaseColor));
        float right = mesh.bounds.max.x;
        yield return Until(() => Mathf.Abs(mesh.bounds.max.x - right) > 0.1f);
    }

    [UnityTest]
    public IEnumerator AFileIsShownColouredByChain()
    {
        var script = new GameObject().AddComponent<SurfaceOfFile>();
        script.path = Repository.CrambinPath;
        yield return null;
        var surface = script.GetComponent<MolecularSurface>();
        yield return Until(() => !surface.IsLoading);
        Assert.That(surface.AtomCount, Is.EqualTo(327));
        surface.Coloring = AtomColoring.Vertices;
        yield return LevelsTest.Settle(surface);
        Color32[] colors = surface.Mesh.colors32;
        Assert.That(colors, Is.All.EqualTo(colors[0]), "crambin has one chain");
        Assert.That(colors[0], Is.Not.EqualTo(surface.BaseColor));
    }

    [UnityTest]
    public IEnumerator ATrajectoryPlays()
    {
        using var folder = new TemporaryFolder();
        string file = folder.File("pair.pdb");
        File.WriteAllText(file, Model(1, 0) + Model(2, 5) + "END\n");
        var script = new GameObject().AddComponent<PlayTrajectory>();
        script.structure = script.trajectory = file;
        yield return null;
        var player = script.GetComponent<TrajectoryPlayer>();
        yield return Until(() => player.ShownFrame >= 0);
        Assert.That(player.FrameCount, Is.EqualTo(2));
        Assert.That(player.IsPlaying);
        yield return Until(() => player.ShownFrame == 1);
        var surface = script.GetComponent<MolecularSurface>();
        yield return Until(() => surface.Mesh.bounds.min.x < -5.5f); // x is negated
        UnityEngine.Object.DestroyImmediate(script.gameObject);
    }

    [UnityTest]
    public IEnumerator OnePlayerMovesSeveralSurfaces()
    {
        using var folder = new TemporaryFolder();
        string file = folder.File("complex.pdb");
        string ligand = "HETATM    2  C   LIG B   2       9.000   0.000   0.000  1.00  0.00           C\nENDMDL\n";
        File.WriteAllText(file, (Model(1, 0) + Model(2, 5)).Replace("ENDMDL\n", ligand) + "END\n");
        var script = new GameObject().AddComponent<PlayComplex>();
        script.complex = file;
        script.ligand = new GameObject().AddComponent<MolecularSurface>();
        script.player = new GameObject().AddComponent<TrajectoryPlayer>();
        yield return Until(() => script.player.ShownFrame >= 0);
        Assert.That(script.player.GetComponent<MolecularSurface>().AtomCount, Is.EqualTo(1));
        yield return Until(() => script.ligand.CurrentLevel.VertexCount > 0);
        Assert.That(script.ligand.Mesh.bounds.center.x, Is.EqualTo(-9).Within(0.2));
        UnityEngine.Object.DestroyImmediate(script.player.gameObject);
    }

    [UnityTest]
    public IEnumerator AnAtomIsFoundUnderAPixel()
    {
        var camera = new GameObject { tag = "MainCamera" }.AddComponent<Camera>();
        camera.transform.position = new Vector3(0, 0, -20);
        var surface = new GameObject().AddComponent<MolecularSurface>();
        surface.SetAtoms(new[] { new Vector3(30, 0, 0), Vector3.zero }, new[] { 1.5f, 1.5f });
        yield return LevelsTest.Settle(surface);
        var script = new GameObject().AddComponent<AtomAtPixel>();
        script.surface = surface;
        Assert.That(script.Find(new Vector3(Screen.width / 2, Screen.height / 2, 0)), Is.EqualTo(1));
        Assert.That(script.Find(Vector3.zero), Is.EqualTo(-1));
    }

    [UnityTest]
    public IEnumerator AtomsOfAScriptComeAgainWhenTheyAreAskedFor()
    {
        var owner = new GameObject();
        owner.AddComponent<MolecularSurface>();
        owner.AddComponent<Helix>();
        var surface = owner.GetComponent<MolecularSurface>();
        yield return LevelsTest.Settle(surface);
        Assert.That(surface.AtomCount, Is.EqualTo(40));
        Assert.That(surface.CurrentLevel.IsFinest);
    }

    private static string Model(int number, float x) => FormattableString.Invariant($"MODEL     {number,4}\n") +
        FormattableString.Invariant($"ATOM      1  C   GLY A   1    {x,8:0.000}   0.000   0.000  1.00  0.00") +
        "           C\nENDMDL\n";

    private static IEnumerator Until(Func<bool> condition)
    {
        var clock = System.Diagnostics.Stopwatch.StartNew();
        while (!condition())
        {
            Assert.That(clock.Elapsed.TotalSeconds, Is.LessThan(LevelsTest.Patience), "still waiting");
            yield return null;
        }
    }
}
