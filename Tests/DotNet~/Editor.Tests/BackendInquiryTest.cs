// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.Threading;

namespace QuickSes.Tests
{
    /// <summary>The inspector asks while CUDA starts, and does not wait.</summary>
    public sealed class BackendInquiryTest
    {
        private const int Patience = 150000; // ms

        [Test]
        public void NobodyWaitsForTheAnswer()
        {
            var inquiry = new BackendInquiry(SurfaceBackend.Cuda);
            NativeGate.Close();
            inquiry.Ask();
            inquiry.Ask();
            Assert.That(() => NativeGate.Waiting, Is.EqualTo(1).After(Patience, 1), "one question is enough");
            Assert.That(inquiry.TryGetAnswer(out _), Is.False);

            NativeGate.Prepare();
            BackendDescription answer = default;
            Assert.That(() => inquiry.TryGetAnswer(out answer), Is.True.After(Patience, 1));
            Assert.That(answer.IsPreparing);
            Assert.That(SurfaceStatus.Preparing(answer.Device, answer.Reason),
                Is.EqualTo("a GPU is being prepared: the driver compiles."));

            Assert.That(NativeGate.Open(), Is.EqualTo(0));
            inquiry.Ask();
            Assert.That(() => inquiry.TryGetAnswer(out answer) && !answer.IsPreparing, Is.True.After(Patience, 1));
            Assert.That(answer.IsAvailable,
                Is.EqualTo(SurfaceContext.GetBackendDescription(SurfaceBackend.Cuda).IsAvailable));
        }
    }
}
