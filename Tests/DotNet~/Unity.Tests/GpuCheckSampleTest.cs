// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using QuickSes.Samples;
using System;
using System.Collections;
using System.Reflection;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>The sample <i>GPU delivery check</i> finds what there is to be found.</summary>
    internal sealed class GpuCheckSampleTest
    {
        private GpuRig _gpu;
        private GpuDeliveryCheck _check;

        [SetUp]
        public void SetUp() => _gpu = new GpuRig();

        [TearDown]
        public void TearDown()
        {
            UnityEngine.Object.DestroyImmediate(_check.gameObject);
            _gpu.Dispose();
        }

        [UnityTest]
        public IEnumerator AllIsGood()
        {
            yield return Run();
            Assert.That(_check.IsGood, _check.Outcome);
            Assert.That(_check.Outcome.Split('\n').Length, Is.EqualTo(6), _check.Outcome);
            Engine.Gui();
        }

        [UnityTest]
        public IEnumerator ReasonsAreShown()
        {
            Engine.ChecksMeshes = false; // what was made, and is not drawn
            _gpu.Gpu.EventFailure = "another GPU draws";
            yield return Run();
            Assert.That(_check.IsGood, Is.False);
            Assert.That(_check.Outcome, Does.Contain("another GPU draws").And.Not.Contain("good"));
        }

        [UnityTest]
        public IEnumerator ItEndsWhereNothingCanBeComputed()
        {
            _gpu.Surface.Spacing = SurfaceSettings.MinSpacing; // too fine
            yield return Run();
            Assert.That(_check.IsGood, Is.False);
            Assert.That(_check.Outcome, Does.Contain("too fine"));
            Assert.That(_check.Outcome.Split('\n').Length, Is.EqualTo(1), _check.Outcome);
        }

        [UnityTest]
        public IEnumerator WhatTheProjectSetComesBack()
        {
            SurfaceScheduler.Delivery = SurfaceDelivery.Auto;
            SurfaceScheduler.GpuMeshPlan = GpuMeshPlan.WholeBuffers;
            yield return Run();
            _check.enabled = false;
            Assert.That((SurfaceScheduler.Delivery, SurfaceScheduler.GpuMeshPlan),
                Is.EqualTo((SurfaceDelivery.Auto, GpuMeshPlan.WholeBuffers)));
        }

        // As an engine would that has a copy of its own.
        [UnityTest]
        public IEnumerator WhatTheEngineOverwritesIsSeen()
        {
            Engine.Animating += Overwrite;
            yield return Run();
            Engine.Animating -= Overwrite;
            Assert.That(_check.IsGood, Is.False);
            Assert.That(_check.Outcome, Does.Contain("some frames later: vertex 0").And.Contain("is at 0, 0, 0"));
        }

        private void Overwrite()
        {
            Engine.ChecksMeshes = false;
            if (_gpu.Surface.UsedDelivery == SurfaceDelivery.Device && GraphicsMemory.TryFind(
                (long)_gpu.Surface.Mesh.GetNativeVertexBufferPtr(0), out _, out Span<byte> bytes))
                bytes.Clear();
        }

        private IEnumerator Run()
        {
            var holder = new GameObject("check");
            holder.SetActive(false);
            _check = holder.AddComponent<GpuDeliveryCheck>();
            Wire("_surface", _gpu.Surface);
            Wire("_camera", _check.transform);
            holder.SetActive(true);
            return SurfaceRig.Until(() => _check.IsDone);
        }

        private void Wire(string field, object value)
        {
            FieldInfo info = typeof(GpuDeliveryCheck).GetField(field, BindingFlags.Instance | BindingFlags.NonPublic);
            Assert.That(info != null && info.IsDefined(typeof(SerializeField), false), field);
            info.SetValue(_check, value);
        }
    }
}
