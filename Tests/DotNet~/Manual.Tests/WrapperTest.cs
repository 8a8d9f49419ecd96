// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes;
using System;
using System.Collections.Generic;
using System.Text.RegularExpressions;
using UMol;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;

/// <summary>Level 1 of the page about UnityMol: what UnityMol relies on when it calls its wrapper.</summary>
internal sealed class WrapperTest
{
    private const float Resolution = 1;

    [Test]
    public void TheMeshIsASurfaceOfTheSelection()
    {
        UnityMolSelection selection = Selections.Blob(150, 1);
        MeshData data = Compute(selection);
        Assert.That(data.nVert, Is.GreaterThan(100));
        Assert.That(data.nTri, Is.GreaterThan(100));
        Assert.That(SignedVolume(data), Is.GreaterThan(0), "front faces outside");
        var edges = new HashSet<(int, int)>();
        for (int i = 0; i < 3 * data.nTri; ++i)
        {
            int a = data.triangles[i], b = data.triangles[i - i % 3 + (i + 1) % 3];
            Assert.That(a, Is.InRange(0, data.nVert - 1));
            Assert.That(edges.Add((a, b)), "each edge once in each direction");
        }
        foreach ((int a, int b) in edges)
            Assert.That(edges.Contains((b, a)), "and in both");
        for (int v = 0; v < data.nVert; ++v)
        {
            Assert.That(data.normals[v].magnitude, Is.EqualTo(1).Within(1e-4));
            Assert.That(data.atomByVert[v], Is.InRange(0, 149));
            Assert.That(data.colors[v], Is.EqualTo(new Color32(255, 255, 255, 255)));
        }
    }

    [Test]
    public void ItsMeshHasWhatUnityMolAsksForAfterwards()
    {
        MeshData data = Compute(Selections.Blob(80, 2));
        Mesh mesh = Show(data);
        Assert.That(mesh.vertexCount, Is.EqualTo(data.nVert));
        Assert.That(mesh.colors32.Length, Is.EqualTo(data.nVert));
        Assert.That(mesh.normals.Length, Is.EqualTo(data.nVert));
        Assert.That(mesh.triangles.Length, Is.EqualTo(3 * data.nTri));
        Assert.That(mesh.isReadable);
        Assert.That(data.atomByVert.Length, Is.GreaterThanOrEqualTo(data.nVert));
        Assert.That(data.normals[0], Is.Not.EqualTo(Vector3.zero), "or UnityMol recalculates them");
    }

    [Test]
    public void VerticesBelongToTheAtomWhoseSurfaceIsNearest()
    {
        UnityMolSelection selection = Selections.Of(
            Selections.Atom(-4, 0, 0, 1.5f), Selections.Atom(4, 0, 0, 1.2f), Selections.Atom(0, 9, 0, 1.8f));
        MeshData data = Compute(selection);
        var seen = new HashSet<int>();
        for (int v = 0; v < data.nVert; ++v)
        {
            int owner = data.atomByVert[v];
            seen.Add(owner);
            for (int i = 0; i < 3; ++i)
                Assert.That(Distance(selection, owner, data.vertices[v]),
                    Is.LessThanOrEqualTo(Distance(selection, i, data.vertices[v]) + 1e-4f));
        }
        Assert.That(seen, Is.EquivalentTo(new[] { 0, 1, 2 }));
    }

    [Test]
    public void OneAtomIsASphere()
    {
        MeshData data = Compute(Selections.Of(Selections.Atom(1, 2, 3, 1.7f)));
        Assert.That(data.nVert, Is.GreaterThan(10));
        for (int v = 0; v < data.nVert; ++v)
        {
            Vector3 arm = data.vertices[v] - new Vector3(1, 2, 3);
            Assert.That(arm.magnitude, Is.EqualTo(1.7f).Within(1e-4));
            Assert.That((data.normals[v] - arm / 1.7f).magnitude, Is.LessThan(1e-3));
            Assert.That(data.atomByVert[v], Is.EqualTo(0));
        }
    }

    [Test]
    public void ASmallerSelectionDoesNotSeeAtomsOfTheOneBefore()
    {
        MeshData data = Compute(Selections.Blob(120, 3));
        UnityMolSelection small = Selections.Blob(12, 4);
        Vector3[] vertices = data.vertices;
        WrapperCudaSES.createCUDASESSurface(-1, small, ref data, Resolution);
        Assert.That(data.vertices, Is.SameAs(vertices), "room is used again");
        MeshData fresh = Compute(small);
        Assert.That(data.nVert, Is.EqualTo(fresh.nVert));
        Assert.That(data.nTri, Is.EqualTo(fresh.nTri));
        for (int v = 0; v < data.nVert; ++v)
        {
            Assert.That(data.vertices[v], Is.EqualTo(fresh.vertices[v]));
            Assert.That(data.atomByVert[v], Is.EqualTo(fresh.atomByVert[v]).And.LessThan(12));
        }
    }

    [Test]
    public void EachArrayGrowsWhenItIsTooShort()
    {
        UnityMolSelection selection = Selections.Blob(100, 5);
        MeshData data = Compute(selection);
        int triangles = data.nTri;
        Vector3[] vertices = data.vertices;
        data.triangles = new int[3];
        WrapperCudaSES.createCUDASESSurface(-1, selection, ref data, Resolution);
        Assert.That(data.vertices, Is.SameAs(vertices));
        Assert.That(data.nTri, Is.EqualTo(triangles));
        Assert.That(data.triangles.Length, Is.GreaterThanOrEqualTo(3 * triangles));
        WrapperCudaSES.createCUDASESSurface(-1, Selections.Blob(400, 6), ref data, Resolution);
        Assert.That(data.nVert, Is.GreaterThan(vertices.Length));
        foreach (Array array in new Array[] { data.vertices, data.normals, data.colors, data.atomByVert })
            Assert.That(array.Length, Is.GreaterThanOrEqualTo(data.nVert));
        Assert.That(SignedVolume(data), Is.GreaterThan(0));
    }

    [Test]
    public void AfterAFailureThereIsAnEmptyMeshAndNotTheLastOne()
    {
        UnityMolSelection selection = Selections.Blob(50, 7);
        MeshData data = Compute(selection);
        Vector3 place = selection.atoms[3].position;
        selection.atoms[3].position.y = float.NaN;
        LogAssert.Expect(LogType.Error, new Regex("SES failed: .*3"));
        WrapperCudaSES.createCUDASESSurface(-1, selection, ref data, Resolution);
        AssertIsEmpty(data);

        selection.atoms[3].position = place;
        WrapperCudaSES.createCUDASESSurface(-1, selection, ref data, Resolution);
        Assert.That(data.nVert, Is.GreaterThan(0), "the next frame is fine again");
    }

    [Test]
    public void AFirstFailureIsAnEmptyMeshToo()
    {
        MeshData data = null;
        LogAssert.Expect(LogType.Error, new Regex("SES failed: .*radius of atom 0"));
        WrapperCudaSES.createCUDASESSurface(-1, Selections.Of(Selections.Atom(0, 0, 0, 0)), ref data);
        AssertIsEmpty(data);
    }

    [Test]
    public void PositionsOfAnExtractedFrameAreTaken()
    {
        UnityMolSelection selection = Selections.Of(Selections.Atom(0, 0, 0, 1.5f));
        selection.extractTrajFramePositions = new List<Vector3[]>
        {
            new[] { new Vector3(5, 0, 0) }, new[] { new Vector3(0, 7, 0) }
        };
        MeshData data = null;
        WrapperCudaSES.createCUDASESSurface(1, selection, ref data, Resolution);
        Assert.That((data.vertices[0] - new Vector3(0, 7, 0)).magnitude, Is.EqualTo(1.5f).Within(1e-4));
    }

    [Test]
    public void TheProbeReachesTheComputation()
    {
        UnityMolSelection selection = Selections.Of(
            Selections.Atom(0, 0, 0, 1.5f), Selections.Atom(3.2f, 0, 0, 1.5f));
        MeshData small = null, large = null;
        WrapperCudaSES.createCUDASESSurface(-1, selection, ref small, Resolution, probeRad: 0.3f);
        WrapperCudaSES.createCUDASESSurface(-1, selection, ref large, Resolution, probeRad: 3);
        Assert.That(SignedVolume(large), Is.GreaterThan(SignedVolume(small) + 1), "it fills the groove");
    }

    private static MeshData Compute(UnityMolSelection selection)
    {
        MeshData data = null;
        WrapperCudaSES.createCUDASESSurface(-1, selection, ref data, Resolution);
        return data;
    }

    // What UnityMol makes of it: the first nVert and 3 nTri elements.
    private static Mesh Show(MeshData data)
    {
        var mesh = new Mesh { indexFormat = IndexFormat.UInt32 };
        mesh.SetVertices(data.vertices.AsSpan(0, data.nVert).ToArray());
        mesh.SetColors(data.colors.AsSpan(0, data.nVert).ToArray());
        mesh.SetIndices(data.triangles.AsSpan(0, 3 * data.nTri).ToArray(), MeshTopology.Triangles, 0);
        mesh.SetNormals(data.normals.AsSpan(0, data.nVert).ToArray());
        return mesh;
    }

    private static void AssertIsEmpty(MeshData data)
    {
        Assert.That(data, Is.Not.Null);
        Assert.That(data.nVert, Is.EqualTo(0));
        Assert.That(data.nTri, Is.EqualTo(0));
        Assert.That(data.normals.Length, Is.GreaterThan(0), "UnityMol looks at the first");
        Mesh mesh = Show(data);
        Assert.That(mesh.vertexCount, Is.EqualTo(0));
        Assert.That(mesh.triangles, Is.Empty);
    }

    private static float Distance(UnityMolSelection selection, int atom, Vector3 point) =>
        (point - selection.atoms[atom].position).magnitude - selection.atoms[atom].radius;

    private static double SignedVolume(MeshData data)
    {
        double sum = 0;
        for (int i = 0; i < 3 * data.nTri; i += 3)
            sum += Vector3.Dot(data.vertices[data.triangles[i]],
                Vector3.Cross(data.vertices[data.triangles[i + 1]], data.vertices[data.triangles[i + 2]]));
        return sum / 6;
    }
}
