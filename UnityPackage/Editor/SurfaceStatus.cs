// SPDX-License-Identifier: MIT
using System;
using System.Globalization;

namespace QuickSes.Editor
{
    /// <summary>The sentences and figures of the status panel. No Editor in here.</summary>
    internal static class SurfaceStatus
    {
        /// <summary>Before the first context is there.</summary>
        public const string Starting = "Starting the back end";

        /// <summary>While the source is read.</summary>
        public const string Reading = "Reading the source";

        private static readonly CultureInfo s_culture = CultureInfo.InvariantCulture;

        /// <summary>How it stands, in words.</summary>
        public static string State(bool hasAtoms, bool isBusy, bool isStarting, float progress, in SurfaceLevel shown,
            bool hasFailed) => isStarting
            ? Starting
            : State(hasAtoms, isBusy, progress, shown.LevelCount > 0, shown.IsFinest && shown.IsOfNewestAtoms,
                hasFailed);

        internal static string State(bool hasAtoms, bool isBusy, float progress, bool isAnyShown, bool isFinest,
            bool hasFailed)
        {
            if (isBusy)
                return progress > 0 && progress < 1 ? "Computing, " + Percent(progress) : "Waiting";
            if (hasFailed)
                return isAnyShown ? "Failed; the last surface is still shown" : "Failed";
            if (!hasAtoms)
                return "No atoms";
            if (isFinest)
                return "The finest surface is shown";
            return isAnyShown ? "Stopped at a coarser or older surface" : "Stopped";
        }

        /// <summary>Such as "2 of 3, 1 Å".</summary>
        public static string Level(int level, int levelCount, float spacing) =>
            string.Format(s_culture, "{0} of {1}, {2:0.###} Å", level + 1, levelCount, spacing);

        /// <summary>Such as "12,345".</summary>
        public static string Count(long count) => count.ToString("N0", s_culture);

        /// <summary>Such as "12.3 ms".</summary>
        public static string Milliseconds(double milliseconds) => milliseconds.ToString(
            milliseconds < 1 ? "0.000" : milliseconds < 100 ? "0.0" : "N0", s_culture) + " ms";

        /// <summary>Such as "1.5 MiB".</summary>
        public static string Bytes(ulong bytes)
        {
            if (bytes < 1024)
                return bytes.ToString(s_culture) + " B";
            string[] units = { "KiB", "MiB", "GiB", "TiB" };
            double value = bytes / 1024.0;
            int unit = 0;
            while (value >= 1024 && unit < units.Length - 1)
            {
                value /= 1024;
                ++unit;
            }
            return value.ToString("0.0", s_culture) + " " + units[unit];
        }

        /// <summary>Such as "3,093.1 Å²".</summary>
        public static string Measure(double value, string unit) => value.ToString("N1", s_culture) + " " + unit;

        /// <summary>Such as "1 outer surface, 2 cavities".</summary>
        public static string Components(ReadOnlySpan<SurfaceComponent> components)
        {
            int cavities = 0;
            foreach (ref readonly SurfaceComponent component in components)
            {
                if (component.IsCavity)
                    ++cavities;
            }
            return Components(components.Length - cavities, cavities);
        }

        internal static string Components(int outerSurfaces, int cavities) =>
            Plural(outerSurfaces, "outer surface", "outer surfaces") + ", " + Plural(cavities, "cavity", "cavities");

        /// <summary>Such as "CUDA, NVIDIA H200"; "" before anything was computed.</summary>
        public static string Backend(SurfaceBackend used, string device)
        {
            if (used == SurfaceBackend.Auto)
                return "";
            string name = used == SurfaceBackend.Cuda ? "CUDA" : "CPU";
            return string.IsNullOrEmpty(device) ? name : name + ", " + device;
        }

        /// <summary>How what is shown came.</summary>
        public static string Delivery(SurfaceDelivery used) =>
            used == SurfaceDelivery.Device ? "On the GPU" : "By host memory";

        /// <summary>Why surfaces do not stay on the GPU; null: they do, or nobody wants it.</summary>
        /// <param name="wanted">Of <see cref="SurfaceScheduler.Delivery"/>.</param>
        /// <param name="reason">Of <see cref="MolecularSurface.DeliveryReason"/>.</param>
        public static string WhyNotOnGpu(SurfaceDelivery wanted, string reason) =>
            wanted == SurfaceDelivery.Host || reason.Length == 0 ? null : $"By host memory: {reason}";

        /// <summary>Why it is not CUDA and what to do; null: it is, or the CPU was asked for.</summary>
        /// <param name="used">The back end that computes.</param>
        /// <param name="reason">The library's, of its <see cref="BackendDescription"/>.</param>
        public static string WhyNotCuda(SurfaceBackend used, string reason)
        {
            if (used != SurfaceBackend.Cpu || string.IsNullOrEmpty(reason))
                return null;
            return IsCpuOnly(reason)
                ? "The native library in use is CPU-only: it was built without CUDA. Released packages compute on " +
                  "NVIDIA GPUs; to build such a one see Documentation~/building.md."
                : $"Not on the GPU: {reason}";
        }

        /// <summary>What is done before the first surface on a GPU.</summary>
        /// <param name="device">The GPU's name.</param>
        /// <param name="reason">The library's, of its <see cref="BackendDescription"/>.</param>
        public static string Preparing(string device, string reason) => $"{device} is being prepared: {reason}.";

        /// <summary>Whether the library's reason for not using CUDA is that it has no CUDA in it.</summary>
        public static bool IsCpuOnly(string reason) =>
            reason.IndexOf("no CUDA back end", StringComparison.OrdinalIgnoreCase) >= 0;

        /// <summary>Why nothing can be computed, and what to do.</summary>
        /// <param name="reason">Of <see cref="MolecularSurface.IsSupported"/>.</param>
        /// <param name="isPlatformSupported">Windows or Linux.</param>
        public static string Unsupported(string reason, bool isPlatformSupported) => reason + (isPlatformSupported
            ? "\n\nInstall a released package, which comes with the native library, or build it: see " +
              "Documentation~/building.md. Restart the Editor after the library was replaced."
            : "\n\nSurfaces are computed on Windows and Linux (x86_64) only. Surfaces that were baked to mesh assets " +
              "there are shown everywhere.");

        private static string Percent(float fraction) => ((int)(100 * fraction)).ToString(s_culture) + " %";

        private static string Plural(int count, string one, string many) =>
            Count(count) + " " + (count == 1 ? one : many);
    }
}
