// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Settings of a surface, keyed in the Animation window or by Timeline.</summary>
    internal sealed class AnimatedSurfaceTest
    {
        private SurfaceRig _rig;

        private MolecularSurface Surface => _rig.Surface;

        [SetUp]
        public void MakeSurface() => _rig = SurfaceRig.WithBlob(60, 1);

        [TearDown]
        public void DestroySurface() => _rig.Dispose();

        [UnityTest]
        public IEnumerator TheSurfaceIsComputedOfThem()
        {
            yield return _rig.Settle();
            double before = Surface.Volume;
            Engine.Animate(Surface, "_probeRadius", 3f);
            Assert.That(Surface.IsBusy);
            yield return _rig.Settle();
            double animated = Surface.Volume;
            Assert.That(animated, Is.GreaterThan(before), "a larger probe reaches less");
            Surface.ProbeRadius = 1.4f;
            yield return _rig.Settle();
            Surface.ProbeRadius = 3;
            yield return _rig.Settle();
            Assert.That(Surface.Volume, Is.EqualTo(animated));
        }

        [UnityTest]
        public IEnumerator WhatStaysComputesNothing()
        {
            yield return _rig.Settle();
            Engine.Animate(Surface, "_probeRadius", Surface.ProbeRadius);
            Assert.That(Surface.IsBusy, Is.False);
        }

        [UnityTest]
        public IEnumerator FramesInWhichTheyStayMakeNoGarbage()
        {
            yield return _rig.Settle();
            var told = (Action)Delegate.CreateDelegate(typeof(Action), Surface, "OnDidApplyAnimationProperties");
            Garbage.AssertNone(() => told());
        }

        [UnityTest]
        public IEnumerator TheyKeepToTheirRanges()
        {
            yield return _rig.Settle();
            Engine.Animate(Surface, "_probeRadius", -1f);
            Assert.That(Surface.ProbeRadius, Is.EqualTo(0));
            yield return _rig.Settle();
            Assert.That(_rig.Failures, Is.Empty);
        }
    }
}
