// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.Reflection;

namespace QuickSes.Tests
{
    public sealed class SurfaceFormTest
    {
        [TestCase("_probeRadius", "Å")]
        [TestCase("_spacing", "Å")]
        [TestCase("_levels", "Å")]
        [TestCase("_frameBudget", "ms")]
        [TestCase("_restDelay", "s")]
        public void FieldsWithAUnitAreThoseOfTheComponent(string field, string unit)
        {
            Assert.That(SurfaceForm.UnitOf(field), Is.EqualTo(unit));
            Assert.That(typeof(MolecularSurface).GetField(field, BindingFlags.Instance | BindingFlags.NonPublic),
                Is.Not.Null);
        }

        [Test]
        public void OtherFieldsHaveNone() => Assert.That(SurfaceForm.UnitOf("_relaxationSteps"), Is.Null);

        [TestCase(SurfaceKind.Ses, true, true)]
        [TestCase(SurfaceKind.Sas, true, false)]
        [TestCase(SurfaceKind.Vdw, false, false)]
        [TestCase(SurfaceKind.Gaussian, false, false)]
        public void ProbeAndMethodCountForTheSurfacesThatHaveThem(SurfaceKind kind, bool probe, bool method)
        {
            Assert.That(IsUsed("_probeRadius", kind), Is.EqualTo(probe));
            Assert.That(IsUsed("_method", kind), Is.EqualTo(method));
            Assert.That(IsUsed("_spacing", kind), Is.True);
            Assert.That(IsUsed("_gaussianIsovalue", kind), Is.EqualTo(kind == SurfaceKind.Gaussian));
        }

        [TestCase(SurfaceKind.Ses, SurfaceMethod.Exact, true)]
        [TestCase(SurfaceKind.Ses, SurfaceMethod.Grid, false)]
        [TestCase(SurfaceKind.Sas, SurfaceMethod.Grid, true)]
        [TestCase(SurfaceKind.Gaussian, SurfaceMethod.Exact, false)]
        public void CreasesAreOfExactSurfaces(SurfaceKind kind, SurfaceMethod method, bool expected) =>
            Assert.That(SurfaceForm.IsUsed("_sharpCreases", kind, method), Is.EqualTo(expected));

        private static bool IsUsed(string field, SurfaceKind kind) =>
            SurfaceForm.IsUsed(field, kind, SurfaceMethod.Exact);
    }
}
