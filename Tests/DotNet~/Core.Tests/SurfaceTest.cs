// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    public sealed class SurfaceTest
    {
        [Test]
        public void OneAtomIsASphere()
        {
            const float radius = 1.7f;
            float[] centre = { 3, -4, 5 };
            using var context = new SurfaceContext();
            context.SetAtoms(centre, new[] { radius });
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Surface = SurfaceKind.Vdw;
            settings.Spacing = 0.1f;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);

            for (int v = 0; v < mesh.VertexCount; ++v)
            {
                double squared = 0, along = 0;
                for (int d = 0; d < 3; ++d)
                {
                    double fromCentre = mesh.Positions[3 * v + d] - (double)centre[d];
                    squared += fromCentre * fromCentre;
                    along += fromCentre * mesh.Normals[3 * v + d];
                }
                Assert.That(Math.Sqrt(squared), Is.EqualTo(radius).Within(1e-5));
                Assert.That(along, Is.EqualTo(radius).Within(1e-5), "normals point away from the centre");
                Assert.That(mesh.Owners[v], Is.Zero);
            }
            // Corners on the sphere: the mesh lies inside it, by less than the sagitta of an edge.
            (double area, double volume) = Meshes.Measure(mesh.Positions, mesh.Indices);
            Assert.That(area / (4 * Math.PI * radius * radius), Is.InRange(0.995, 1.0));
            Assert.That(volume / (4.0 / 3 * Math.PI * radius * radius * radius), Is.InRange(0.99, 1.0));
            Assert.That(Meshes.IsClosed(mesh.Indices), Is.True);
        }

        [Test]
        public void HardEdgesAreClosedByTheirNumbers(
            [Values(SurfaceKind.Ses, SurfaceKind.Sas, SurfaceKind.Vdw)] SurfaceKind kind)
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Surface = kind;
            settings.Creases = settings.HardEdges = true;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            ReadOnlySpan<uint> repeated = mesh.Repeated;
            Assert.That(repeated.Length, Is.Positive);
            uint single = (uint)(mesh.VertexCount - repeated.Length);
            uint[] indices = mesh.Indices.ToArray();
            Assert.That(Meshes.IsClosed(indices), Is.False, "each side has vertices of its own");
            for (int i = 0; i < indices.Length; ++i)
                if (indices[i] >= single)
                    indices[i] = repeated[(int)(indices[i] - single)];
            Assert.That(Meshes.IsClosed(indices), Is.True);
            for (int k = 0; k < repeated.Length; ++k)
            {
                Assert.That(k == 0 || repeated[k - 1] < repeated[k], "in ascending order");
                int vertex = 3 * (int)(single + k), other = 3 * (int)repeated[k];
                Assert.That(mesh.Positions.Slice(vertex, 3).SequenceEqual(mesh.Positions.Slice(other, 3)), Is.True);
            }
            settings.HardEdges = false;
            Assert.That(Meshes.Compute(context, settings).Repeated.IsEmpty, Is.True);
        }

        [Test]
        public void CrambinIsClosed([Values] SurfaceKind kind)
        {
            using Structure structure = Meshes.Crambin();
            using SurfaceContext context = Meshes.ContextOf(structure);
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Surface = kind;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.TriangleCount, Is.GreaterThan(1000));
            Assert.That(Meshes.IsClosed(mesh.Indices), Is.True);
            Assert.That(context.AtomCount, Is.EqualTo(structure.AtomCount));

            Assert.That(context.TryGetReport(out SurfaceReport report), Is.True);
            (double area, double volume) = Meshes.Measure(mesh.Positions, mesh.Indices);
            Assert.That(volume, Is.Positive);
            Assert.That(report.TriangleArea, Is.EqualTo(area).Within(1e-5).Percent);
            Assert.That(report.TriangleVolume, Is.EqualTo(volume).Within(1e-4).Percent);
            Assert.That(report.Area, Is.InRange(area, 1.2 * area));
            Assert.That(report.Volume, Is.EqualTo(volume).Within(2).Percent);
            Assert.That(report.MeasuredBy,
                Is.EqualTo(kind == SurfaceKind.Sas || kind == SurfaceKind.Vdw ? SurfaceMeasuredBy.Atoms :
                    SurfaceMeasuredBy.Normals));

            float[] low = { float.MaxValue, float.MaxValue, float.MaxValue },
                high = { float.MinValue, float.MinValue, float.MinValue };
            for (int i = 0; i < mesh.Positions.Length; ++i)
            {
                low[i % 3] = Math.Min(low[i % 3], mesh.Positions[i]);
                high[i % 3] = Math.Max(high[i % 3], mesh.Positions[i]);
            }
            Assert.That(mesh.BoundsMin, Is.EqualTo((low[0], low[1], low[2])));
            Assert.That(mesh.BoundsMax, Is.EqualTo((high[0], high[1], high[2])));
            foreach (uint owner in mesh.Owners)
                Assert.That(owner, Is.LessThan(context.AtomCount));
        }

        [Test]
        public void ReversedWindingMirrorsTheTriangles()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            SurfaceMeshView outward = Meshes.Compute(context, settings);
            double volume = Meshes.Measure(outward.Positions, outward.Indices).Volume;
            settings.Winding = SurfaceWinding.Reversed;
            SurfaceMeshView reversed = Meshes.Compute(context, settings);
            Assert.That(Meshes.Measure(reversed.Positions, reversed.Indices).Volume,
                Is.EqualTo(-volume).Within(1e-9).Percent);
        }

        [Test]
        public void PatchTypesComeIfAskedFor()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            Assert.That(Meshes.Compute(context, settings).HasPatches, Is.False);
            settings.PatchTypes = true;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.Patches.Length, Is.EqualTo(mesh.VertexCount));
            Assert.That(mesh.Patches.ToArray(),
                Is.SupersetOf(new[] { SurfacePatch.Contact, SurfacePatch.Toroidal, SurfacePatch.Reentrant }));
        }

        [Test]
        public void NoAtomsGiveAnEmptyMesh()
        {
            using var context = new SurfaceContext();
            context.SetAtoms(default, default);
            SurfaceMeshView mesh = Meshes.Compute(context, SurfaceSettings.Default);
            Assert.That(mesh.VertexCount, Is.Zero);
            Assert.That(mesh.Positions.IsEmpty && mesh.Indices.IsEmpty && mesh.Owners.IsEmpty, Is.True);
            SurfaceMeshView nothing = default;
            Assert.That(nothing.IsValid && nothing.Positions.IsEmpty && nothing.Vertices.IsEmpty, Is.True);
        }

        [Test]
        public void IndexedPositionsAreThoseThatWerePicked()
        {
            using Structure structure = Meshes.Crambin();
            using SurfaceContext context = Meshes.ContextOf(structure);
            SurfaceMeshView direct = Meshes.Compute(context, SurfaceSettings.Default);
            float[] expected = direct.Positions.ToArray();

            // Every atom at twice its place in a larger array, between atoms that must not be looked at.
            var wide = new float[6 * structure.AtomCount];
            var indices = new uint[structure.AtomCount];
            Array.Fill(wide, float.NaN);
            for (int i = 0; i < indices.Length; ++i)
            {
                indices[i] = (uint)(2 * i);
                structure.Positions.Slice(3 * i, 3).CopyTo(wide.AsSpan(6 * i));
            }
            context.SetAtoms(new float[3 * structure.AtomCount], structure.Radii);
            Assert.That(context.SetPositions(wide, indices), Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(Meshes.Compute(context, SurfaceSettings.Default).Positions.SequenceEqual(expected), Is.True);
        }

        [Test]
        public void EstimateIsNearTheMesh()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            Assert.That(context.Estimate(settings, out SurfaceSizeEstimate estimate), Is.EqualTo(QuickSesStatus.Ok));
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(estimate.Fits, Is.True);
            Assert.That((double)estimate.Vertices, Is.EqualTo(mesh.VertexCount).Within(25).Percent);
            Assert.That((double)estimate.Triangles, Is.EqualTo(mesh.TriangleCount).Within(25).Percent);
        }

        [Test]
        public void MeasuringCanBeSwitchedOff()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            Assert.That(settings.Measure, Is.True);
            settings.Measure = false;
            Meshes.Compute(context, settings);
            context.TryGetReport(out SurfaceReport report);
            Assert.That((report.Area, report.Volume), Is.EqualTo((0.0, 0.0)));
            Assert.That(report.MeshBytes, Is.Positive);
        }

        [Test]
        public void ComponentsAreTheSpheresAndTheWholeSurface()
        {
            float[] radii = { 1.5f, 2, 3 };
            using var context = new SurfaceContext();
            context.SetAtoms(new float[] { 0, 0, 0, 20, 0, 0, 0, 30, 0 }, radii);
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Spacing = 0.2f;
            Assert.That(settings.Components, Is.False);
            Assert.That(Meshes.Compute(context, settings).Components.IsEmpty, Is.True);
            settings.Components = true;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.Components.Length, Is.EqualTo(3));
            double area = 0, volume = 0;
            long triangles = 0;
            var found = new double[3];
            for (int k = 0; k < 3; ++k)
            {
                SurfaceComponent component = mesh.Components[k];
                Assert.That(component.IsCavity, Is.False);
                area += component.Area;
                volume += component.Volume;
                triangles += component.Triangles;
                found[k] = component.Volume;
            }
            Array.Sort(found);
            for (int k = 0; k < 3; ++k)
                Assert.That(found[k] / (4.0 / 3 * Math.PI * Math.Pow(radii[k], 3)), Is.EqualTo(1).Within(0.1).Percent);
            Assert.That(triangles, Is.EqualTo(mesh.TriangleCount));
            context.TryGetReport(out SurfaceReport report);
            Assert.That(area, Is.EqualTo(report.Area).Within(1e-9).Percent);
            Assert.That(volume, Is.EqualTo(report.Volume).Within(1e-9).Percent);

            Meshes.Compute(context, settings);
            Assert.That(() => mesh.Components.Length, Throws.InvalidOperationException);
        }

        [Test]
        public void OwnersMayBeLeftOut()
        {
            using var context = new SurfaceContext();
            context.SetAtoms(new float[] { 0, 0, 0, 3, 0, 0 }, new float[] { 1.5f, 2 });
            SurfaceSettings settings = SurfaceSettings.Default;
            Assert.That(settings.WithoutOwners, Is.False);
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.Owners.Length, Is.EqualTo(mesh.VertexCount));
            float[] positions = mesh.Positions.ToArray();
            settings.WithoutOwners = true;
            mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.Owners.IsEmpty, Is.True);
            Assert.That(mesh.Positions.ToArray(), Is.EqualTo(positions));
        }

        [Test]
        public void ComponentsHavePlacesAndVerticesTheirNumbers()
        {
            using var context = new SurfaceContext();
            context.SetAtoms(new float[] { 0, 0, 0, 20, 0, 0, 0, 30, 0, 1, 30, 0 }, new float[] { 1.5f, 2, 3, 3 });
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Components = true;
            Assert.That(settings.ComponentIds, Is.False);
            Assert.That(Meshes.Compute(context, settings).ComponentIds.IsEmpty, Is.True);
            Assert.That(() => Meshes.Compute(context, settings).GetComponentAtoms(), Throws.TypeOf<QuickSesException>());
            settings.Components = false;
            settings.ComponentIds = true;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.Components.Length, Is.EqualTo(3));
            Assert.That(mesh.ComponentIds.Length, Is.EqualTo(mesh.VertexCount));
            uint[][] atoms = mesh.GetComponentAtoms();
            Assert.That(atoms.Length, Is.EqualTo(3));
            var centers = new (float X, float Y, float Z)[] { (0, 0, 0), (20, 0, 0), (0.5f, 30, 0) };
            for (int k = 0; k < 3; ++k)
            {
                SurfaceComponent component = mesh.Components[k];
                int which = component.Center.Y > 10 ? 2 : component.Center.X > 10 ? 1 : 0;
                Assert.That(component.Center.X, Is.EqualTo(centers[which].X).Within(0.01));
                Assert.That(component.Center.Y, Is.EqualTo(centers[which].Y).Within(0.01));
                Assert.That(component.Center.Z, Is.EqualTo(centers[which].Z).Within(0.01));
                Assert.That(atoms[k], Is.EqualTo(which == 2 ? new uint[] { 2, 3 } : new[] { (uint)which }));
                float low = float.PositiveInfinity, high = float.NegativeInfinity;
                for (int v = 0; v < mesh.VertexCount; ++v)
                {
                    if (mesh.ComponentIds[v] != k) continue;
                    low = Math.Min(low, mesh.Positions[3 * v]);
                    high = Math.Max(high, mesh.Positions[3 * v]);
                }
                Assert.That((component.BoundsMin.X, component.BoundsMax.X), Is.EqualTo((low, high)));
            }
            Meshes.Compute(context, settings);
            Assert.That(() => mesh.ComponentIds.Length, Throws.InvalidOperationException);
            Assert.That(() => mesh.GetComponentAtoms(), Throws.InvalidOperationException);
        }

        [Test]
        public void CavitiesCanBeLeftOut()
        {
            var positions = new float[3 * 500];
            var radii = new float[500];
            for (int i = 0; i < 500; ++i) // all over a sphere
            {
                double up = 1 - (2 * i + 1) / 500.0, turn = Math.PI * (3 - Math.Sqrt(5)) * i;
                double across = 6 * Math.Sqrt(1 - up * up);
                positions[3 * i] = (float)(across * Math.Cos(turn));
                positions[3 * i + 1] = (float)(across * Math.Sin(turn));
                positions[3 * i + 2] = (float)(6 * up);
                radii[i] = 1.7f;
            }
            using var context = new SurfaceContext();
            context.SetAtoms(positions, radii);
            SurfaceSettings settings = SurfaceSettings.Default;
            Assert.That(settings.OuterOnly, Is.False);
            int whole = Meshes.Compute(context, settings).TriangleCount;
            settings.OuterOnly = true;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.Components.Length, Is.EqualTo(2));
            SurfaceComponent outer = mesh.Components[0], cavity = mesh.Components[1];
            Assert.That((outer.IsCavity, cavity.IsCavity), Is.EqualTo((false, true)));
            Assert.That(mesh.TriangleCount, Is.EqualTo(outer.Triangles));
            Assert.That(outer.Triangles + cavity.Triangles, Is.EqualTo(whole));
            Assert.That(mesh.BoundsMax, Is.EqualTo(outer.BoundsMax));
        }

        [Test]
        public void StageTimesHaveNames()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            context.EnableStageTimes(true);
            Meshes.Compute(context, SurfaceSettings.Default);
            context.TryGetReport(out SurfaceReport report);
            Assert.That(report.StageCount, Is.Positive);
            for (int k = 0; k < report.StageCount; ++k)
            {
                Assert.That(report.GetStage(k).Name, Does.Match("^[a-z_]+$"));
                Assert.That(report.GetStage(k).Milliseconds, Is.Not.Negative);
            }
            foreach (int none in new[] { -1, report.StageCount })
                Assert.That(() => report.GetStage(none), Throws.TypeOf<ArgumentOutOfRangeException>());
        }

        [Test]
        public void ViewEndsWithTheNextMesh()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            Assert.That(context.TryGetMesh(out _), Is.False);
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Tag = 41;
            SurfaceMeshView first = Meshes.Compute(context, settings);
            float[] positions = first.Positions.ToArray();
            Assert.That(first.Tag, Is.EqualTo(41));
            Assert.That(context.TryGetMesh(out SurfaceMeshView again), Is.True);
            Assert.That(again.Positions.SequenceEqual(positions), Is.True);

            settings.Tag = 42;
            SurfaceMeshView second = Meshes.Compute(context, settings);
            Assert.That(first.IsValid, Is.False);
            Assert.That(again.IsValid, Is.False);
            Assert.That(() => first.Positions.Length, Throws.InvalidOperationException);
            Assert.That(() => first.GetComponentAtoms(), Throws.InvalidOperationException);
            Assert.That(second.Tag, Is.EqualTo(42));
            Assert.That(second.Positions.SequenceEqual(positions), Is.True, "same input, same bytes");
        }
    }
}
