// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    /// <summary>The limits that C# names are those of the library.</summary>
    public sealed class SettingLimitsTest
    {
        private delegate void Set(ref SurfaceSettings settings, float value);

        [Test]
        public void LimitsAreThoseOfTheLibrary()
        {
            using var context = new SurfaceContext(new SurfaceContextOptions { Backend = SurfaceBackend.Cpu });
            context.SetAtoms(new float[] { 0, 0, 0 }, new[] { 1.5f });
            Check(context, (ref SurfaceSettings s, float value) => s.ProbeRadius = value, 0,
                SurfaceSettings.MaxProbeRadius);
            Check(context, (ref SurfaceSettings s, float value) => s.Spacing = value, SurfaceSettings.MinSpacing,
                SurfaceSettings.MaxSpacing);
            Check(context, (ref SurfaceSettings s, float value) => s.SetLevels(new[] { value }),
                SurfaceSettings.MinSpacing, SurfaceSettings.MaxSpacing);
            Check(context, (ref SurfaceSettings s, float value) => s.FrameBudget = value, 0,
                SurfaceSettings.MaxFrameBudget);
            Check(context, (ref SurfaceSettings s, float value) => s.GaussianRadiusScale = value,
                SurfaceSettings.MinGaussianRadiusScale, SurfaceSettings.MaxGaussianRadiusScale);
            Check(context, (ref SurfaceSettings s, float value) => s.GaussianIsovalue = value,
                SurfaceSettings.MinGaussianIsovalue, SurfaceSettings.MaxGaussianIsovalue);
            Check(context, (ref SurfaceSettings s, float value) => s.RelaxationSteps = (uint)Math.Round(value), 0,
                SurfaceSettings.MaxRelaxationSteps, 1);
        }

        private static void Check(SurfaceContext context, Set set, float min, float max, float step = 0)
        {
            Assert.That(IsTaken(context, set, min), Is.True, $"{min}");
            Assert.That(IsTaken(context, set, max), Is.True, $"{max}");
            Assert.That(IsTaken(context, set, step > 0 ? max + step : max * 1.001f), Is.False, $"above {max}");
            if (step == 0)
                Assert.That(IsTaken(context, set, min == 0 ? -0.001f : min * 0.999f), Is.False, $"below {min}");
        }

        // Too fine for the memory there is, is not out of range.
        private static bool IsTaken(SurfaceContext context, Set set, float value)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            set(ref settings, value);
            try
            {
                context.Begin(settings);
                context.Cancel();
                context.Wait();
                return true;
            }
            catch (QuickSesException e)
            {
                Assert.That(e.Status, Is.EqualTo(QuickSesStatus.InvalidArgument), e.Message);
                return false;
            }
        }
    }
}
