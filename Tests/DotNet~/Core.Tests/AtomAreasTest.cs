// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    public sealed class AtomAreasTest
    {
        private static double Sum(ReadOnlySpan<double> values)
        {
            double sum = 0;
            foreach (double value in values)
                sum += value;
            return sum;
        }

        private static SurfaceSettings SettingsOf(SurfaceKind kind)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Surface = kind;
            settings.AtomAreas = true;
            return settings;
        }

        [Test]
        public void TwoBallsInClosedForm()
        {
            using var context = new SurfaceContext();
            context.SetAtoms(new float[] { 0, 0, 0, 2, 0, 0 }, new float[] { 1.5f, 1.5f });
            SurfaceSettings settings = SettingsOf(SurfaceKind.Vdw);
            settings.Delivery = MeshDelivery.None;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.VertexCount, Is.Zero);
            Assert.That(mesh.AtomAreas.Length, Is.EqualTo(2));
            double each = 4 * Math.PI * 1.5 * 1.5 - 2 * Math.PI * 1.5 * 0.5;
            foreach (double area in mesh.AtomAreas)
                Assert.That(area, Is.EqualTo(each).Within(1e-4));
            Assert.That(context.TryGetReport(out SurfaceReport report), Is.True);
            Assert.That(report.MeasuredBy, Is.EqualTo(SurfaceMeasuredBy.Atoms));
            Assert.That(report.Area, Is.EqualTo(2 * each).Within(1e-4));
            Assert.That(report.TriangleArea, Is.Zero);
        }

        [Test]
        public void TheyAddUpToTheArea([Values] SurfaceKind kind, [Values] bool withMesh)
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SettingsOf(kind);
            settings.Delivery = withMesh ? MeshDelivery.Host : MeshDelivery.None;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.AtomAreas.Length, Is.EqualTo(context.AtomCount));
            Assert.That(context.TryGetReport(out SurfaceReport report), Is.True);
            Assert.That(Sum(mesh.AtomAreas), Is.EqualTo(report.Area).Within(1e-4).Percent);
        }

        [Test]
        public void OnlyIfAskedFor()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            Assert.That(Meshes.Compute(context, SurfaceSettings.Default).AtomAreas.IsEmpty, Is.True);
            Assert.That(default(SurfaceMeshView).AtomAreas.IsEmpty, Is.True);
        }

        [Test]
        public void AreKeptWithTheMesh()
        {
            using var kept = new KeptMesh();
            double[] before;
            using (SurfaceContext context = Meshes.CrambinContext())
            {
                SurfaceMeshView mesh = Meshes.Compute(context, SettingsOf(SurfaceKind.Ses));
                before = mesh.AtomAreas.ToArray();
                Assert.That(context.Keep(kept), Is.True);
                Assert.That(() => mesh.AtomAreas.Length, Throws.InvalidOperationException);
            }
            Assert.That(kept.View.AtomAreas.ToArray(), Is.EqualTo(before));
        }

        [Test]
        public void WhatIsHandedOutNowhereHasNoArraysAndCanNotBeKept()
        {
            using var kept = new KeptMesh();
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SettingsOf(SurfaceKind.Ses);
            settings.Delivery = MeshDelivery.None;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.VertexCount, Is.Positive);
            Assert.That(mesh.Positions.IsEmpty, Is.True);
            Assert.That(mesh.Normals.IsEmpty, Is.True);
            Assert.That(mesh.Owners.IsEmpty, Is.True);
            Assert.That(mesh.Patches.IsEmpty, Is.True);
            Assert.That(mesh.Indices.IsEmpty, Is.True);
            Assert.That(mesh.AtomAreas.Length, Is.EqualTo(context.AtomCount));
            Assert.That(() => context.Keep(kept), Throws.TypeOf<QuickSesException>());
        }
    }
}
