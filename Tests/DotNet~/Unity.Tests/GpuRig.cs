// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;
using UnityEngine;
using UnityEngine.Rendering;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>A machine with CUDA, as far as meshes that stay on the GPU are concerned, and a surface on it.</summary>
    internal sealed class GpuRig : IDisposable
    {
        public const int Atoms = 120;

        public readonly StandInGpu Gpu = new StandInGpu();
        public readonly SurfaceRig Rig;
        public readonly Vector3[] Start;
        public readonly float[] Radii;
        private readonly IGpuLibrary _library = GpuDelivery.Library;

        public GpuRig(SurfaceDelivery delivery = SurfaceDelivery.Device)
        {
            GpuDelivery.Library = Gpu;
            SurfaceScheduler.Delivery = delivery;
            TestMolecules.Blob(Atoms, 1, out Start, out Radii);
            Rig = NewSurface("surface");
        }

        public MolecularSurface Surface => Rig.Surface;

        public MeshRenderer Renderer => Rig.GameObject.GetComponent<MeshRenderer>();

        public SurfaceRig NewSurface(string name)
        {
            var rig = new SurfaceRig(name);
            rig.Surface.Levels = Array.Empty<float>();
            rig.Surface.FrameBudget = 0;
            rig.Surface.RestDelay = 1e6f;
            rig.Surface.SharpCreases = false;
            return rig;
        }

        public Vector3[] Moved(int seed) => TestMolecules.Moved(Start, seed);

        public IEnumerator ShowFirst()
        {
            Surface.SetAtoms(Start, Radii);
            yield return Rig.Settle();
        }

        public IEnumerator Show(Vector3[] positions)
        {
            int before = Rig.Levels.Count;
            Surface.SetPositions(positions);
            yield return SurfaceRig.Until(() => Rig.Levels.Count > before && !Surface.IsBusy);
        }

        /// <summary>
        /// What is drawn of a surface are the bytes that the host path makes: no call of the engine but those to the mesh.
        /// </summary>
        public static void AssertDrawn(MolecularSurface surface)
        {
            var expected = new Mesh();
            surface.CopyTo(expected);
            Mesh mesh = surface.GetComponent<MeshFilter>().sharedMesh;
            Assert.That(mesh, Is.SameAs(surface.Mesh));
            int vertices = expected.vertexCount;
            Assert.That(surface.CurrentLevel.VertexCount, Is.EqualTo(vertices));
            Assert.That(vertices, Is.GreaterThan(0));
            bool hasAtoms = mesh.HasVertexAttribute(VertexAttribute.TexCoord7);
            AssertStart(Stream(mesh, 0), Stream(expected, 0), "vertices");
            AssertStart(Stream(mesh, 1), hasAtoms ? MemoryMarshal.AsBytes(surface.Owners) : Stream(expected, 1), "atoms");
            Assert.That(mesh.HasVertexAttribute(VertexAttribute.TexCoord1),
                Is.EqualTo(expected.HasVertexAttribute(VertexAttribute.TexCoord1)));
            AssertStart(Stream(mesh, 2), Stream(expected, 2), "texture coordinates");
            if (!hasAtoms || surface.Mesh.triangles.Length == expected.triangles.Length)
                Assert.That(WithoutPoints(mesh.triangles), Is.EqualTo(expected.triangles), "triangles");
            Bounds bounds = surface.GetComponent<MeshRenderer>().localBounds;
            Assert.That(bounds.center, Is.EqualTo(expected.bounds.center));
            Assert.That(bounds.size, Is.EqualTo(expected.bounds.size));
            Object.DestroyImmediate(expected);
        }

        public void Dispose()
        {
            RenderThread.IsRunning = true;
            Rig.Dispose();
            RenderThread.Run();
            Assert.That(Gpu.Faults, Is.Empty);
            Assert.That(Gpu.TargetCount, Is.EqualTo(0));
            Assert.That(GpuDelivery.Targets, Is.EqualTo(0));
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            SurfaceScheduler.GpuMeshPlan = GpuMeshPlan.SubMeshPerFrame;
            GpuDelivery.Library = _library;
            Gpu.Dispose();
        }

        private static ReadOnlySpan<byte> Stream(Mesh mesh, int stream)
        {
            GraphicsMemory.TryFind((long)mesh.GetNativeVertexBufferPtr(stream), out _, out Span<byte> bytes);
            return bytes;
        }

        private static void AssertStart(ReadOnlySpan<byte> actual, ReadOnlySpan<byte> expected, string what)
        {
            Assert.That(actual.Length, Is.GreaterThanOrEqualTo(expected.Length), what);
            Assert.That(actual.Slice(0, expected.Length).SequenceEqual(expected), what);
        }

        // Triangles that are hidden, and what is behind the last one.
        private static int[] WithoutPoints(int[] triangles)
        {
            var left = new List<int>(triangles.Length);
            for (int i = 0; i < triangles.Length; i += 3)
                if (triangles[i] != triangles[i + 1] || triangles[i] != triangles[i + 2])
                    left.AddRange(triangles.Skip(i).Take(3));
            return left.ToArray();
        }
    }
}
