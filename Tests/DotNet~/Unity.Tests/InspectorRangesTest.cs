// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What the inspector, or a file, says out of range is brought into the range that setters take.</summary>
    internal sealed class InspectorRangesTest
    {
        [UnityTest]
        public IEnumerator WhatIsEditedIsLimited()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            MolecularSurface surface = rig.Surface;
            Inspector.Set(surface, "_probeRadius", -3f);
            Inspector.Set(surface, "_relaxationSteps", 500);
            Inspector.Set(surface, "_frameBudget", float.NaN);
            Inspector.Set(surface, "_restDelay", -1f);
            Assert.That((surface.ProbeRadius, surface.RelaxationSteps, surface.FrameBudget, surface.RestDelay),
                Is.EqualTo((0f, SurfaceSettings.MaxRelaxationSteps, 0f, 0f)));
            Inspector.Set(surface, "_probeRadius", 1e9f);
            Inspector.Set(surface, "_spacing", 0f);
            Assert.That((surface.ProbeRadius, surface.Spacing),
                Is.EqualTo((SurfaceSettings.MaxProbeRadius, SurfaceSettings.MinSpacing)));
            surface.ProbeRadius = 10;
            Inspector.Set(surface, "_spacing", 0.5f);
            Assert.That((surface.ProbeRadius, surface.Spacing), Is.EqualTo((10f, 0.5f)));
            rig.Dispose();
            yield return null;
        }

        [UnityTest]
        public IEnumerator LevelsToo()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            Inspector.Set(rig.Surface, "_levels", new[] { 150, 1, -5, float.NaN });
            Assert.That(rig.Surface.Levels, Is.EqualTo(new[]
                { SurfaceSettings.MaxSpacing, 1, SurfaceSettings.MinSpacing, SurfaceSettings.MinSpacing }));
            Inspector.Set(rig.Surface, "_levels", new float[SurfaceSettings.MaxLevels + 2]);
            Assert.That(rig.Surface.Levels.Length, Is.EqualTo(SurfaceSettings.MaxLevels));
            Assert.That(() => rig.Surface.Levels = rig.Surface.Levels, Throws.Nothing);
            rig.Dispose();
            yield return null;
        }

        [UnityTest]
        public IEnumerator GaussianSettingsToo()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            MolecularSurface surface = rig.Surface;
            foreach (float low in new[] { 0, -1, float.NaN, float.NegativeInfinity })
            {
                Inspector.Set(surface, "_gaussianRadiusScale", low);
                Inspector.Set(surface, "_gaussianIsovalue", low);
                Assert.That((surface.GaussianRadiusScale, surface.GaussianIsovalue),
                    Is.EqualTo((SurfaceSettings.MinGaussianRadiusScale, SurfaceSettings.MinGaussianIsovalue)));
            }
            foreach (float high in new[] { 1e9f, float.PositiveInfinity })
            {
                Inspector.Set(surface, "_gaussianRadiusScale", high);
                Inspector.Set(surface, "_gaussianIsovalue", high);
                Assert.That((surface.GaussianRadiusScale, surface.GaussianIsovalue),
                    Is.EqualTo((SurfaceSettings.MaxGaussianRadiusScale, SurfaceSettings.MaxGaussianIsovalue)));
            }
            Inspector.Set(surface, "_gaussianRadiusScale", 2f);
            Inspector.Set(surface, "_gaussianIsovalue", 3f);
            Assert.That((surface.GaussianRadiusScale, surface.GaussianIsovalue), Is.EqualTo((2f, 3f)));
            rig.Dispose();
            yield return null;
        }
    }
}
