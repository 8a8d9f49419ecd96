// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.Events;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What is wired in the inspector listens, so that failures are not logged, unless it is not called.</summary>
    internal sealed class WiredEventsTest
    {
        [UnityTest]
        public IEnumerator FailuresAreToldToWhatIsWiredOrLogged()
        {
            var made = new GameObject("surface");
            var surface = made.AddComponent<MolecularSurface>();
            int told = 0;
            surface.Events.Failed.AddListener(message => ++told);
            surface.Source.SetFile("/no/such/folder/a.pdb");
            LogAssert.Expect(LogType.Error, new Regex("surface: .*a.pdb"));
            Assert.That(surface.LoadSource(), Is.False);
            Assert.That(told, Is.EqualTo(1));

            string wired = null;
            Wiring.Wire(surface.Events.Failed, made, message => wired = message);
            surface.Source.SetFile("/no/such/folder/b.pdb");
            Assert.That(surface.LoadSource(), Is.False); // the log would fail the test
            Assert.That(wired, Does.Contain("b.pdb"));
            Assert.That(told, Is.EqualTo(2));
            Object.DestroyImmediate(made);
            yield return null;
        }

        // As + in the inspector leaves it, and as it is once what was wired is deleted.
        [Test]
        public void ARowWithoutTargetOrMethodIsNoListener()
        {
            var made = new GameObject("surface");
            var deleted = new GameObject("deleted");
            var surface = made.AddComponent<MolecularSurface>();
            var player = made.AddComponent<TrajectoryPlayer>();
            foreach (UnityEvent<string> failed in new[] { surface.Events.Failed, player.Events.Failed })
            {
                Wiring.Wire(failed, null, message => { }, method: "");
                Wiring.Wire(failed, made, message => { }, method: "");
                Wiring.Wire(failed, deleted, message => { });
            }
            Object.DestroyImmediate(deleted);
            surface.Source.SetFile("/no/such/folder/a.pdb");
            player.StructureSource.SetFile("/no/such/folder/b.pdb");
            LogAssert.Expect(LogType.Error, new Regex("surface: .*a.pdb"));
            LogAssert.Expect(LogType.Error, new Regex("surface: structure: .*b.pdb"));
            Assert.That(surface.LoadSource(), Is.False);
            Assert.That(player.Load(), Is.False);
            Object.DestroyImmediate(made);
        }

        [UnityTest]
        public IEnumerator WhatIsNotCalledIsNoListener([Values] UnityEventCallState state, [Values] bool isEditMode)
        {
            if (isEditMode)
                Engine.EnterEditMode();
            bool isCalled = state == UnityEventCallState.EditorAndRuntime ||
                (state == UnityEventCallState.RuntimeOnly && !isEditMode);
            var made = new GameObject("surface");
            var surface = made.AddComponent<MolecularSurface>();
            var player = made.AddComponent<TrajectoryPlayer>();
            int ofSurface = 0, ofPlayer = 0;
            Wiring.Wire(surface.Events.Failed, made, message => { }, UnityEventCallState.Off);
            Wiring.Wire(player.Events.Failed, made, message => { }, UnityEventCallState.Off);
            Wiring.Wire(surface.Events.Failed, made, message => ++ofSurface, state);
            Wiring.Wire(player.Events.Failed, made, message => ++ofPlayer, state);

            surface.Source.SetFile("/no/such/folder/a.pdb");
            player.StructureSource.SetFile("/no/such/folder/b.pdb");
            if (!isCalled)
            {
                LogAssert.Expect(LogType.Error, new Regex("surface: .*a.pdb"));
                LogAssert.Expect(LogType.Error, new Regex("surface: structure: .*b.pdb"));
            }
            Assert.That(surface.LoadSource(), Is.False);
            Assert.That(player.Load(), Is.False);
            Assert.That((ofSurface, ofPlayer), Is.EqualTo(isCalled ? (1, 1) : (0, 0)));
            Object.DestroyImmediate(made);
            yield return null;
        }
    }
}
