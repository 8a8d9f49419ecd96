// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    /// <summary>What is out of its range is refused with the range, and changes nothing.</summary>
    internal sealed class SettingRangesTest
    {
        private SurfaceRig _rig;

        [SetUp]
        public void SetUp() => _rig = new SurfaceRig();

        [TearDown]
        public void TearDown() => _rig.Dispose();

        [Test]
        public void Numbers()
        {
            MolecularSurface surface = _rig.Surface;
            float least = SurfaceSettings.MinSpacing, most = SurfaceSettings.MaxSpacing;
            Check(() => surface.ProbeRadius, value => surface.ProbeRadius = value, 0, SurfaceSettings.MaxProbeRadius);
            Check(() => surface.Spacing, value => surface.Spacing = value, least, most);
            Check(() => surface.FrameBudget, value => surface.FrameBudget = value, 0, SurfaceSettings.MaxFrameBudget);
            Check(() => surface.RestDelay, value => surface.RestDelay = value, 0, float.PositiveInfinity);
            Check(() => surface.Levels[1], value => surface.Levels = new[] { 3, value }, least, most);
        }

        [Test]
        public void Steps()
        {
            MolecularSurface surface = _rig.Surface;
            foreach (int wrong in new[] { -1, int.MinValue, SurfaceSettings.MaxRelaxationSteps + 1, int.MaxValue })
                Assert.That(() => surface.RelaxationSteps = wrong,
                    Throws.TypeOf<ArgumentOutOfRangeException>().With.Message.Contains("0 to 100"));
            Assert.That(surface.RelaxationSteps, Is.EqualTo(1));
            surface.RelaxationSteps = SurfaceSettings.MaxRelaxationSteps;
            Assert.That(surface.RelaxationSteps, Is.EqualTo(SurfaceSettings.MaxRelaxationSteps));
        }

        [Test]
        public void Choices()
        {
            MolecularSurface surface = _rig.Surface;
            foreach (int wrong in new[] { -1, 4, int.MaxValue })
            {
                Assert.That(() => surface.Surface = (SurfaceKind)wrong, Throws.TypeOf<ArgumentOutOfRangeException>());
                Assert.That(() => surface.Method = (SurfaceMethod)wrong, Throws.TypeOf<ArgumentOutOfRangeException>());
                Assert.That(() => surface.Backend = (SurfaceBackend)wrong,
                    Throws.TypeOf<ArgumentOutOfRangeException>());
            }
            Assert.That((surface.Surface, surface.Method, surface.Backend),
                Is.EqualTo((SurfaceKind.Ses, SurfaceMethod.Exact, SurfaceBackend.Auto)));
            surface.Surface = SurfaceKind.Vdw;
            surface.Backend = SurfaceBackend.Cpu;
        }

        [Test]
        public void AsManyLevelsAsThereCanBe()
        {
            var levels = new float[SurfaceSettings.MaxLevels + 1];
            for (int k = 0; k < levels.Length; ++k)
                levels[k] = 1 + k;
            Assert.That(() => _rig.Surface.Levels = levels,
                Throws.TypeOf<ArgumentOutOfRangeException>().With.Message.Contains("at most 8"));
            Assert.That(_rig.Surface.Levels, Is.EqualTo(new[] { 2f, 1 }));
            Array.Resize(ref levels, SurfaceSettings.MaxLevels);
            _rig.Surface.Levels = levels;
            Assert.That(_rig.Surface.Levels, Is.EqualTo(levels));
        }

        private static void Check(Func<float> get, Action<float> set, float min, float max)
        {
            float before = get();
            foreach (float wrong in new[] { float.NaN, -1, float.NegativeInfinity, min - 1e-4f, 2 * max })
            {
                if (wrong >= min && wrong <= max)
                    continue; // twice infinity
                Assert.That(() => set(wrong),
                    Throws.TypeOf<ArgumentOutOfRangeException>().With.Message.Contains("must be " +
                        FormattableString.Invariant($"{min}")));
                Assert.That(get(), Is.EqualTo(before));
            }
            foreach (float right in new[] { min, max })
            {
                set(right);
                Assert.That(get(), Is.EqualTo(right));
            }
        }
    }
}
