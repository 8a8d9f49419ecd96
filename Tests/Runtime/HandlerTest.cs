// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Handlers of events may do anything.</summary>
    internal sealed class HandlerTest
    {
        private SurfaceRig _rig;

        [TearDown]
        public void TearDown() => _rig?.Dispose();

        [UnityTest]
        public IEnumerator WhatAHandlerThrowsKeepsNoOtherEventBack()
        {
            _rig = SurfaceRig.WithBlob(40, 1);
            _rig.Surface.SurfaceUpdated += level =>
            {
                if (level.IsFinest)
                    throw new InvalidOperationException("a handler's own fault");
            };
            LogAssert.Expect(LogType.Exception, new Regex("own fault"));
            yield return _rig.Settle();
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Finished, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator NothingIsFinishedThatWasClearedOrDestroyed()
        {
            _rig = SurfaceRig.WithBlob(40, 3);
            _rig.Surface.SurfaceUpdated += level =>
            {
                if (level.IsFinest)
                    _rig.Surface.ClearAtoms();
            };
            yield return SurfaceRig.Until(() => _rig.Surface.AtomCount == 0);
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Finished, Is.EqualTo(0));
            _rig.Dispose();

            _rig = SurfaceRig.WithBlob(40, 3);
            GameObject doomed = _rig.GameObject;
            _rig.Surface.SurfaceUpdated += level =>
            {
                if (level.IsFinest)
                    Object.DestroyImmediate(doomed);
            };
            yield return SurfaceRig.Until(() => doomed == null);
            Assert.That(_rig.Finished, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator AHandlerMayDisableWhatItFeeds()
        {
            using (SurfaceRig other = SurfaceRig.WithBlob(30, 4))
            {
                yield return other.Settle();
                TestMolecules.Blob(40, 5, out Vector3[] positions, out float[] radii);
                _rig = new SurfaceRig();
                _rig.Surface.AtomsRequested += () =>
                {
                    _rig.Surface.SetAtoms(positions, radii);
                    _rig.Surface.enabled = false;
                };
                yield return SurfaceRig.Until(() => !_rig.Surface.enabled);
                yield return SurfaceRig.Frames(3);
                Assert.That(_rig.Surface.IsBusy, Is.False);
                Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
                Assert.That(SurfaceScheduler.WaitingCount, Is.EqualTo(0));
            }
        }

        [UnityTest]
        public IEnumerator AHandlerMayDestroyWhatAsksForAtoms()
        {
            _rig = new SurfaceRig();
            GameObject doomed = _rig.GameObject;
            _rig.Surface.AtomsRequested += () => Object.DestroyImmediate(doomed);
            yield return SurfaceRig.Until(() => doomed == null);
            yield return SurfaceRig.Frames(2);
        }
    }
}
