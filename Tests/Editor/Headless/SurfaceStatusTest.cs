// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;

namespace QuickSes.Tests
{
    public sealed class SurfaceStatusTest
    {
        [TestCase(true, true, 0.5f, false, false, false, "Computing, 50 %")]
        [TestCase(true, true, 0f, true, false, false, "Waiting")]
        [TestCase(true, true, 0.25f, true, false, true, "Computing, 25 %")] // of the try after a failure
        [TestCase(true, false, 1f, true, true, false, "The finest surface is shown")]
        [TestCase(true, false, 1f, true, false, false, "Stopped at a coarser or older surface")]
        [TestCase(true, false, 1f, false, false, false, "Stopped")]
        [TestCase(true, false, 1f, true, true, true, "Failed; the last surface is still shown")]
        [TestCase(false, false, 0f, false, false, true, "Failed")]
        [TestCase(false, false, 0f, false, false, false, "No atoms")]
        public void StateIsToldInWords(bool hasAtoms, bool isBusy, float progress, bool isAnyShown, bool isFinest,
            bool hasFailed, string text) => Assert.That(
            SurfaceStatus.State(hasAtoms, isBusy, progress, isAnyShown, isFinest, hasFailed), Is.EqualTo(text));

        [Test]
        public void NothingIsShownBeforeTheFirstSurface() =>
            Assert.That(SurfaceStatus.State(true, false, false, 0, default, false), Is.EqualTo("Stopped"));

        [Test]
        public void StartingIsTold() =>
            Assert.That(SurfaceStatus.State(true, true, true, 0, default, false), Is.EqualTo("Starting the back end"));

        [Test]
        public void LevelsAreCountedFromOne() =>
            Assert.That(SurfaceStatus.Level(0, 3, 0.25f), Is.EqualTo("1 of 3, 0.25 Å"));

        [TestCase(0.0421, "0.042 ms")]
        [TestCase(1, "1.0 ms")]
        [TestCase(12.34, "12.3 ms")]
        [TestCase(100, "100 ms")]
        [TestCase(12345.6, "12,346 ms")]
        public void MillisecondsHaveThreeDigits(double milliseconds, string text) =>
            Assert.That(SurfaceStatus.Milliseconds(milliseconds), Is.EqualTo(text));

        [TestCase(0ul, "0 B")]
        [TestCase(1023ul, "1023 B")]
        [TestCase(1536ul, "1.5 KiB")]
        [TestCase(1024ul * 1024, "1.0 MiB")]
        [TestCase(141ul << 30, "141.0 GiB")]
        [TestCase(ulong.MaxValue, "16777216.0 TiB")]
        public void BytesHaveBinaryUnits(ulong bytes, string text) =>
            Assert.That(SurfaceStatus.Bytes(bytes), Is.EqualTo(text));

        [Test]
        public void FiguresHaveSeparatorsAndUnits()
        {
            Assert.That(SurfaceStatus.Count(1234567), Is.EqualTo("1,234,567"));
            Assert.That(SurfaceStatus.Measure(3093.14, "Å²"), Is.EqualTo("3,093.1 Å²"));
            Assert.That(SurfaceStatus.Components(1, 0), Is.EqualTo("1 outer surface, 0 cavities"));
            Assert.That(SurfaceStatus.Components(2, 1), Is.EqualTo("2 outer surfaces, 1 cavity"));
        }

        [Test]
        public void TheDeviceIsNamedOnceThereIsOne()
        {
            Assert.That(SurfaceStatus.Backend(SurfaceBackend.Auto, null), Is.Empty);
            Assert.That(SurfaceStatus.Backend(SurfaceBackend.Cuda, "a GPU"), Is.EqualTo("CUDA, a GPU"));
            Assert.That(SurfaceStatus.Backend(SurfaceBackend.Cpu, ""), Is.EqualTo("CPU"));
        }

        [Test]
        public void ItIsToldWhyNotCudaUnlessItIsOrTheCpuWasAskedFor()
        {
            Assert.That(SurfaceStatus.WhyNotCuda(SurfaceBackend.Cuda, ""), Is.Null);
            Assert.That(SurfaceStatus.WhyNotCuda(SurfaceBackend.Cpu, ""), Is.Null);
            Assert.That(SurfaceStatus.WhyNotCuda(SurfaceBackend.Cpu, "the driver is too old"),
                Does.Contain("the driver is too old"));
            Assert.That(SurfaceStatus.WhyNotCuda(SurfaceBackend.Cpu, "this build has no CUDA back end"),
                Does.Contain("CPU-only").And.Contain("Documentation~/building.md"));
        }

        [Test]
        public void ItIsToldWhyNotOnTheGpuWhereThatIsWanted()
        {
            Assert.That(SurfaceStatus.WhyNotOnGpu(SurfaceDelivery.Auto, ""), Is.Null);
            Assert.That(SurfaceStatus.WhyNotOnGpu(SurfaceDelivery.Host, "Delivery is Host."), Is.Null);
            Assert.That(SurfaceStatus.WhyNotOnGpu(SurfaceDelivery.Device, "Vulkan is not supported."),
                Does.Contain("Vulkan is not supported."));
            Assert.That(SurfaceStatus.Delivery(SurfaceDelivery.Device), Is.Not.EqualTo(
                SurfaceStatus.Delivery(SurfaceDelivery.Host)));
        }

        [Test]
        public void WhereNothingCanBeComputedTheNextStepIsNamed()
        {
            Assert.That(SurfaceStatus.Unsupported("missing", true), Does.StartWith("missing").And.Contain("Install"));
            Assert.That(SurfaceStatus.Unsupported("missing", false),
                Does.StartWith("missing").And.Contain("Windows and Linux"));
        }
    }
}
