// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// Whether meshes can stay on the GPU here, and the events that all surfaces share. Main thread only; no garbage.
    /// </summary>
    internal static partial class GpuDelivery
    {
        private static IGpuLibrary s_library = new GpuLibrary();
        private static uint s_checkedVersion;
        private static GpuGraphics s_graphics;
        private static string s_reason = "";

        /// <summary>Tests have one of their own.</summary>
        public static IGpuLibrary Library
        {
            get => s_library;
            set
            {
                s_library = value;
                ChooseAgain();
            }
        }

        /// <summary>Another number after each choice of a delivery: what failed before is tried again.</summary>
        public static uint Version { get; private set; } = 1;

        /// <summary>How many have a target.</summary>
        public static int Targets { get; set; }

        /// <summary>Of the buffers.</summary>
        public static GpuGraphics Graphics => s_graphics;

        public static void ChooseAgain() => ++Version;

        /// <summary>As far as all surfaces are concerned; else why not.</summary>
        public static bool IsPossible(out string reason)
        {
            if (s_checkedVersion != Version)
            {
                s_reason = WhyNot(SurfaceScheduler.Delivery);
                s_checkedVersion = Version;
            }
            reason = s_reason;
            return reason.Length == 0;
        }

        /// <summary>
        /// Lets the thread that draws do what was submitted, before it draws anything that is asked for later.
        /// </summary>
        public static void Issue()
        {
            int number = s_library.NextEvent();
            if (number != 0)
                IssueInEngine(s_library.EventFunction, number);
        }

        private static string WhyNot(SurfaceDelivery delivery)
        {
            if (delivery == SurfaceDelivery.Host)
                return "SurfaceScheduler.Delivery is Host.";
            string name = "No graphics API";
            s_graphics = default;
            AskEngine(ref s_graphics, ref name);
            if (s_graphics == default)
                return $"{name} is not supported: meshes stay on the GPU with OpenGLCore, and with Direct3D11.";
            if (s_graphics == GpuGraphics.D3d11 && delivery == SurfaceDelivery.Auto)
                return "With Direct3D11 nobody has tried it yet: SurfaceScheduler.Delivery = Device does.";
            return s_library.IsUsable(s_graphics, out string reason) ? "" : reason;
        }

        // The engine's part: what it draws with (0: none of those), under which name; and events.
        static partial void AskEngine(ref GpuGraphics graphics, ref string name);

        static partial void IssueInEngine(IntPtr function, int number);
    }
}
