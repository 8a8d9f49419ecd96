// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.IO;
using System.Linq;

namespace QuickSes.Tests
{
    /// <summary>The inspector knows a library without CUDA by a sentence of the native sources.</summary>
    public sealed class CpuOnlyReasonTest
    {
        [Test]
        public void TheLibrarysSentenceIsRecognised()
        {
            string source = File.ReadAllText(
                Path.Combine(Repository.Root, "NativePlugin", "Source~", "capi", "backends.cpp"));
            Assert.That(source.Split('"').Count(SurfaceStatus.IsCpuOnly), Is.EqualTo(1));
        }

        [Test]
        public void TheLibraryThatIsLoadedGivesAReasonUnlessItHasCuda()
        {
            BackendDescription cuda = SurfaceContext.GetBackendDescription(SurfaceBackend.Cuda);
            BackendDescription auto = SurfaceContext.GetBackendDescription(SurfaceBackend.Auto);
            Assert.That(SurfaceStatus.WhyNotCuda(SurfaceBackend.Cpu, auto.Reason) == null,
                Is.EqualTo(cuda.IsAvailable));
        }
    }
}
