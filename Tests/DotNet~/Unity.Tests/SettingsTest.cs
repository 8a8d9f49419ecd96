// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using System.Reflection;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Options of the project, and scripts that override them.</summary>
    internal sealed class SettingsTest
    {
        private static readonly uint s_defaultThreads = (uint)Math.Max(2, Environment.ProcessorCount - 1);

        [SetUp]
        public void SetUp() => SurfaceScheduler.ResetOptions();

        [TearDown]
        public void TearDown()
        {
            Engine.PutIntoResources(QuickSesSettings.AssetName, null);
            SurfaceScheduler.ResetOptions();
        }

        [UnityTest]
        public IEnumerator WithoutAnAssetTheDefaultsHold()
        {
            Assert.That(QuickSesSettings.Find() == null);
            Assert.That(Options(), Is.EqualTo((4, s_defaultThreads, 0ul, 0)));
            yield return null;
        }

        [UnityTest]
        public IEnumerator ScriptsOverrideTheProjectUntilPlayModeBegins()
        {
            Put(2, 3, 500, 1);
            Assert.That(Options(), Is.EqualTo((2, 3u, 500000000ul, 1)));
            SurfaceScheduler.MaxContexts = 7;
            SurfaceScheduler.Threads = 0;
            SurfaceScheduler.MemoryBudget = 5;
            SurfaceScheduler.Device = 2;
            yield return null;
            Assert.That(Options(), Is.EqualTo((7, 0u, 5ul, 2)));
            Engine.EnterEditMode();
            Engine.EnterPlayModeWithoutReload(typeof(MolecularSurface).Assembly);
            Assert.That(Options(), Is.EqualTo((2, 3u, 500000000ul, 1)), "as in the project");

            // A scheduler that was never asked before it is set is the project's in all else.
            SurfaceScheduler.ResetOptions();
            SurfaceScheduler.MaxContexts = 9;
            Assert.That(Options(), Is.EqualTo((9, 3u, 500000000ul, 1)));
        }

        [UnityTest]
        public IEnumerator EditsOfTheProjectHoldAtOnceAndLoadingItChangesNothing()
        {
            Put(2, 3, 500, 1);
            SurfaceRig rig = SurfaceRig.WithBlob(30, 1);
            yield return rig.Settle();
            SurfaceScheduler.MaxContexts = 7;
            int contexts = SurfaceScheduler.ContextCount;
            SurfaceScheduler.FollowProjectOptions(); // the asset was loaded
            Assert.That(Options(), Is.EqualTo((7, 3u, 500000000ul, 1)));
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(contexts).And.GreaterThan(0));

            Set(QuickSesSettings.Find(), "_threads", 1); // by whomever, such as Undo
            SurfaceScheduler.FollowProjectOptions();
            Assert.That(Options(), Is.EqualTo((2, 1u, 500000000ul, 1)));
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator WhatIsOutOfRangeInAFileIsBroughtIntoIt()
        {
            Put(0, -4, -1, -2);
            Assert.That(Options(), Is.EqualTo((1, s_defaultThreads, 0ul, 0)));
            foreach (int delivery in new[] { -1, (int)SurfaceDelivery.Device + 1 })
            {
                Put(1, 1, 0, 0, (SurfaceDelivery)delivery, float.PositiveInfinity);
                SurfaceScheduler.ResetOptions();
                Assert.That(Options(), Is.EqualTo((1, 1u, 0ul, 0)), "which are not");
                Assert.That(SurfaceScheduler.Delivery, Is.EqualTo(SurfaceDelivery.Host));
                Assert.That(SurfaceScheduler.UploadBudget, Is.EqualTo(0));
            }
            Assert.That(() => SurfaceScheduler.MaxContexts = 0, Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => SurfaceScheduler.Device = -1, Throws.TypeOf<ArgumentOutOfRangeException>());
            yield return null;
        }

        [UnityTest]
        public IEnumerator ContextsAreMadeByTheProjectsOptions()
        {
            Put(1, 2, 0, 0);
            SurfaceScheduler.ReleaseContexts();
            var rigs = new[] { SurfaceRig.WithBlob(300, 1), SurfaceRig.WithBlob(300, 2), SurfaceRig.WithBlob(300, 3) };
            int most = 0;
            yield return SurfaceRig.Until(() =>
            {
                most = Math.Max(most, SurfaceScheduler.ContextCount);
                return !Array.Exists(rigs, rig => rig.Surface.IsBusy);
            });
            Assert.That(most, Is.EqualTo(1));
            foreach (SurfaceRig rig in rigs)
                rig.Dispose();
        }

        private static (int, uint, ulong, int) Options() => (SurfaceScheduler.MaxContexts, SurfaceScheduler.Threads,
            SurfaceScheduler.MemoryBudget, SurfaceScheduler.Device);

        private static void Put(int maxContexts, int threads, int megabytes, int device,
            SurfaceDelivery delivery = SurfaceDelivery.Host, float uploadBudget = 2)
        {
            var settings = ScriptableObject.CreateInstance<QuickSesSettings>();
            Set(settings, "_maxContexts", maxContexts);
            Set(settings, "_threads", threads);
            Set(settings, "_memoryBudget", megabytes);
            Set(settings, "_device", device);
            Set(settings, "_delivery", delivery);
            Set(settings, "_uploadBudget", uploadBudget);
            Engine.PutIntoResources(QuickSesSettings.AssetName, settings);
        }

        // As the inspector does.
        private static void Set(QuickSesSettings settings, string field, object value) => typeof(QuickSesSettings)
            .GetField(field, BindingFlags.Instance | BindingFlags.NonPublic).SetValue(settings, value);
    }
}
