// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What is wired in the inspector listens, so that failures are not logged.</summary>
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
            Wiring.Wire(surface.Events.Failed, message => wired = message);
            surface.Source.SetFile("/no/such/folder/b.pdb");
            Assert.That(surface.LoadSource(), Is.False); // the log would fail the test
            Assert.That(wired, Does.Contain("b.pdb"));
            Assert.That(told, Is.EqualTo(2));
            Object.DestroyImmediate(made);
            yield return null;
        }
    }
}
