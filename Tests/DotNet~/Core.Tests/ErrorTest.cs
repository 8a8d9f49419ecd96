// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    public sealed class ErrorTest
    {
        private static readonly float[] TwoAtoms = { 0, 0, 0, 3, 0, 0 };
        private static readonly float[] TwoRadii = { 1.7f, 1.5f };

        private static SurfaceContext ContextOfTwo()
        {
            var context = new SurfaceContext();
            context.SetAtoms(TwoAtoms, TwoRadii);
            return context;
        }

        private static QuickSesException Thrown(TestDelegate call) => Assert.Throws<QuickSesException>(call);

        [Test]
        public void BadAtomsAreNamed()
        {
            using SurfaceContext context = ContextOfTwo();
            SurfaceMeshView mesh = Meshes.Compute(context, SurfaceSettings.Default);
            QuickSesException error = Thrown(() => context.SetPositions(new[] { 0, 0, 0, 3, float.NaN, 0 }));
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(error.Message, Does.Contain("atom 1").And.Contain("finite"));
            Assert.That(Thrown(() => context.SetAtoms(TwoAtoms, new[] { -1f, 1 })).Message,
                Does.Contain("radius of atom 0"));
            Assert.That(Thrown(() => context.SetPositions(TwoAtoms, new uint[] { 1, 2 })).Message,
                Does.Contain("indices[1]"));
            Assert.That(mesh.IsValid, Is.True);
            Assert.That(Meshes.Compute(context, SurfaceSettings.Default).VertexCount, Is.Positive);
        }

        [Test]
        public void WrongLengthsAreNamed()
        {
            using SurfaceContext context = ContextOfTwo();
            Assert.That(() => context.SetAtoms(new float[5], TwoRadii),
                Throws.ArgumentException.With.Property("ParamName").EqualTo("positions"));
            Assert.That(() => context.SetPositions(new float[9]),
                Throws.ArgumentException.With.Property("ParamName").EqualTo("positions"));
            Assert.That(() => context.SetPositions(TwoAtoms, new uint[3]),
                Throws.ArgumentException.With.Property("ParamName").EqualTo("indices"));
            foreach (int length in new[] { 7, 8 })
                Assert.That(() => context.SetPositions(new float[length], new uint[2]),
                    Throws.ArgumentException.With.Property("ParamName").EqualTo("positions"));
            Assert.That(() => context.SetColors(new byte[7]),
                Throws.ArgumentException.With.Property("ParamName").EqualTo("rgba"));
            Assert.That(() => context.SetVisible(new byte[3]),
                Throws.ArgumentException.With.Property("ParamName").EqualTo("visible"));
            Assert.That(() => context.SetTexcoords(new float[3]),
                Throws.ArgumentException.With.Property("ParamName").EqualTo("uv"));
        }

        [Test]
        public void BadSettingsAreNamed()
        {
            using SurfaceContext context = ContextOfTwo();
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Spacing = 0;
            Assert.That(Thrown(() => context.Begin(settings)).Message, Does.Contain("spacing"));
            settings = SurfaceSettings.Default;
            settings.Surface = (SurfaceKind)17;
            Assert.That(Thrown(() => context.Compute(settings, out _)).Message, Does.Contain("surface is 17"));
            Assert.That(() => context.Begin(default),
                Throws.ArgumentException.With.Message.Contains("SurfaceSettings.Default"));
            Assert.That(() => settings.SetLevels(new float[SurfaceSettings.MaxLevels + 1]), Throws.ArgumentException);
            settings.SetLevels(new float[SurfaceSettings.MaxLevels]);
            Assert.That(settings.LevelCount, Is.EqualTo(SurfaceSettings.MaxLevels));
            Assert.That(() => settings.GetLevel(settings.LevelCount), Throws.TypeOf<ArgumentOutOfRangeException>());
        }

        [Test]
        public void SettingsReachTheLibrary()
        {
            // Each is refused by its own name, so each lands in its own field.
            ExpectRefused("probe_radius", (ref SurfaceSettings settings) => settings.ProbeRadius = -1);
            ExpectRefused("method", (ref SurfaceSettings settings) => settings.Method = (SurfaceMethod)9);
            ExpectRefused("winding", (ref SurfaceSettings settings) => settings.Winding = (SurfaceWinding)9);
            ExpectRefused("relaxation_steps", (ref SurfaceSettings settings) => settings.RelaxationSteps = 1000);
            ExpectRefused("slice_size", (ref SurfaceSettings settings) => settings.SliceSize = 3);
            ExpectRefused("vertex_layout",
                (ref SurfaceSettings settings) => settings.VertexLayout = (SurfaceVertexLayout)9);
            ExpectRefused("frame_budget_ms", (ref SurfaceSettings settings) => settings.FrameBudget = -1);
            ExpectRefused("levels", (ref SurfaceSettings settings) => settings.SetLevels(new[] { 1f, 2f }));
        }

        private delegate void Change(ref SurfaceSettings settings);

        private static void ExpectRefused(string name, Change change)
        {
            using SurfaceContext context = ContextOfTwo();
            SurfaceSettings settings = SurfaceSettings.Default;
            change(ref settings);
            Assert.That(Thrown(() => context.Begin(settings)).Message, Does.Contain(name));
        }

        [Test]
        public void NoAtomsIsAProgrammingError()
        {
            using var context = new SurfaceContext();
            Assert.That(Thrown(() => context.Begin(SurfaceSettings.Default)).Status,
                Is.EqualTo(QuickSesStatus.NoAtoms));
            Assert.That(Thrown(() => context.Compute(SurfaceSettings.Default, out _)).Status,
                Is.EqualTo(QuickSesStatus.NoAtoms));
            Assert.That(context.TryGetReport(out _), Is.False);
        }

        [Test]
        public void WhatIsTooFineIsReturned()
        {
            using var context = new SurfaceContext();
            context.SetAtoms(new float[] { -50000, 0, 0, 50000, 0, 0 }, TwoRadii);
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Spacing = 0.01f;
            Assert.That(context.LastError, Is.Empty);
            Assert.That(context.Compute(settings, out SurfaceMeshView mesh), Is.EqualTo(QuickSesStatus.TooFine));
            Assert.That(context.LastError, Does.Contain("spacing"));
            Assert.That(mesh.VertexCount, Is.Zero);
        }

        [Test]
        public void MemoryThatDoesNotSufficeIsReturned()
        {
            using Structure structure = Meshes.Crambin();
            using var context = new SurfaceContext(
                new SurfaceContextOptions { Backend = SurfaceBackend.Cpu, MemoryBudget = 1 << 20 });
            context.SetAtoms(structure.Positions, structure.Radii);
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Spacing = 0.1f;
            Assert.That(context.Compute(settings, out _), Is.EqualTo(QuickSesStatus.OutOfMemory));
            Assert.That(context.LastError, Does.Contain("budget"));
        }

        [Test]
        public void ContextsTellWhatTheyUse()
        {
            using var cpu = new SurfaceContext(new SurfaceContextOptions { Backend = SurfaceBackend.Cpu, Threads = 1 });
            Assert.That(cpu.Backend, Is.EqualTo(SurfaceBackend.Cpu));
            Assert.That(cpu.Description.IsAvailable, Is.True);
            Assert.That(cpu.Description.Device, Does.Contain(", 1 thread)"));
            Assert.That(cpu.Description.TotalMemory, Is.GreaterThan(cpu.Description.FreeMemory));
            Assert.That(cpu.Description.Processors, Is.InRange(1u, (uint)Environment.ProcessorCount));
            Assert.That(SurfaceContext.NativeVersion, Does.Match(@"^\d+\.\d+\.\d+"));

            bool hasCuda = SurfaceContext.IsSupported(SurfaceBackend.Cuda, out string reason);
            Assert.That(hasCuda, Is.EqualTo(SurfaceContext.DeviceCount > 0));
            Assert.That(reason == "", Is.EqualTo(hasCuda));
            var options = new SurfaceContextOptions { Backend = SurfaceBackend.Cuda };
            Assert.That(SurfaceContext.TryCreate(options, out SurfaceContext cuda, out QuickSesError error),
                Is.EqualTo(hasCuda));
            cuda?.Dispose();
            if (!hasCuda)
            {
                Assert.That(error.Status, Is.EqualTo(QuickSesStatus.BackendUnavailable));
                Assert.That(error.Message, Does.Contain(reason));
                Assert.That(Thrown(() => new SurfaceContext(options)).Message, Is.EqualTo(error.Message));
                Assert.That(SurfaceContext.GetBackendDescription(SurfaceBackend.Auto).Reason, Does.Contain(reason));
            }
            Assert.That(SurfaceContext.TryCreate(new SurfaceContextOptions { Backend = (SurfaceBackend)9 }, out cuda,
                out error), Is.False);
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(cuda, Is.Null);
        }
    }
}
