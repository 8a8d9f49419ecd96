// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    /// <summary>Which levels are computed when.</summary>
    internal sealed class SurfaceJobPlanTest
    {
        [Test]
        public void LaddersFallToTheFinest()
        {
            Assert.That(Ladder(0.5f, 2, 1), Is.EqualTo(new[] { 2, 1, 0.5f }));
            Assert.That(Ladder(0.5f, 1, 4, 2), Is.EqualTo(new[] { 4, 2, 1, 0.5f }), "in any order");
            Assert.That(Ladder(1, 2, 1, 0.5f), Is.EqualTo(new[] { 2, 1f }), "only coarser ones");
            Assert.That(Ladder(1, 2, 2, 2), Is.EqualTo(new[] { 2, 1f }), "once each");
            Assert.That(Ladder(0.5f), Is.EqualTo(new[] { 0.5f }));
            Assert.That(Ladder(0.5f, float.NaN), Is.EqualTo(new[] { 0.5f }));
            Assert.That(Ladder(0.1f, 9, 8, 7, 6, 5, 4, 3, 2, 1).Length, Is.EqualTo(SurfaceSettings.MaxLevels + 1));
        }

        [Test]
        public void NewAtomsComeThroughAllLevels()
        {
            AssertPlan(SurfaceChange.Shape, float.PositiveInfinity, 33, false, 0, 2, 1, 0.5f);
            AssertPlan(SurfaceChange.Shape, 0.5f, 33, false, 0, 2, 1, 0.5f);
        }

        [Test]
        public void WhoIsNotAloneGetsTheCoarsestFirst() =>
            AssertPlan(SurfaceChange.Shape, float.PositiveInfinity, 33, true, 0, 2);

        [Test]
        public void MovingAtomsHaveABudget()
        {
            AssertPlan(SurfaceChange.Positions, 0.5f, 33, false, 33, 2, 1, 0.5f);
            AssertPlan(SurfaceChange.Positions, float.PositiveInfinity, 33, true, 33, 2, 1, 0.5f);
            AssertPlan(SurfaceChange.Positions, float.PositiveInfinity, 0, false, 0, 2, 1, 0.5f);
        }

        [Test]
        public void RefinementGoesOnFromWhatIsShown()
        {
            AssertPlan(SurfaceChange.None, 2, 33, true, 0, 1, 0.5f);
            AssertPlan(SurfaceChange.None, 1, 33, false, 0, 0.5f);
            AssertPlan(SurfaceChange.None, float.PositiveInfinity, 33, false, 0, 2, 1, 0.5f);
        }

        [Test]
        public void TheFinestLevelHasCreasesUnlessAtomsMove()
        {
            Assert.That(HasCreases(SurfaceChange.Shape, false));
            Assert.That(HasCreases(SurfaceChange.None, true));
            Assert.That(HasCreases(SurfaceChange.Positions, false), Is.False);
            Assert.That(HasCreases(SurfaceChange.Shape, true), Is.False, "the coarsest is computed, and nothing else");
        }

        private static bool HasCreases(SurfaceChange change, bool othersWait)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Creases = settings.HardEdges = true;
            SurfaceJobPlan.Choose(ref settings, new[] { 2, 1, 0.5f }, change, float.PositiveInfinity, 0, othersWait);
            Assert.That(settings.HardEdges, Is.EqualTo(settings.Creases));
            return settings.Creases;
        }

        private static float[] Ladder(float finest, params float[] levels)
        {
            var ladder = new float[SurfaceSettings.MaxLevels + 1];
            int count = SurfaceJobPlan.MakeLadder(levels, finest, ladder);
            return ladder.AsSpan(0, count).ToArray();
        }

        private static void AssertPlan(SurfaceChange change, float shown, float frameBudget, bool othersWait,
            float expectedBudget, params float[] expected)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            SurfaceJobPlan.Choose(ref settings, new[] { 2, 1, 0.5f }, change, shown, frameBudget, othersWait);
            var levels = new float[settings.LevelCount + 1];
            for (int k = 0; k < settings.LevelCount; ++k)
                levels[k] = settings.GetLevel(k);
            levels[settings.LevelCount] = settings.Spacing;
            Assert.That(levels, Is.EqualTo(expected));
            Assert.That(settings.FrameBudget, Is.EqualTo(expectedBudget));
        }
    }
}
