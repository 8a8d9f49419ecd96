// SPDX-License-Identifier: MIT
// Options: those of the project, which scripts override until play mode ends.
using System;

namespace QuickSes
{
    /// <summary>Options of the scheduler, as <see cref="SurfaceScheduler"/> documents them.</summary>
    internal struct SchedulerOptions
    {
        public int MaxContexts;
        public uint Threads;
        public ulong MemoryBudget;
        public int Device;
        public double UploadBudget;
        public SurfaceDelivery Delivery;

        /// <summary>So that the game keeps a processor.</summary>
        public static uint DefaultThreads => (uint)Math.Max(2, Environment.ProcessorCount - 1);

        public static SchedulerOptions Default =>
            new SchedulerOptions
            {
                MaxContexts = 4, Threads = DefaultThreads, UploadBudget = 2, Delivery = SurfaceDelivery.Host
            };
    }

    public static partial class SurfaceScheduler
    {
        private static SchedulerOptions s_options;
        private static SchedulerOptions s_projectOptions; // as they were read
        private static bool s_areOptionsRead;

        /// <summary>
        /// The most contexts per back end, at least 1; default 4. Each keeps memory for its largest surface. More let
        /// more surfaces be computed at a time. <see cref="MolecularSurface.ComputeNow"/> makes one more if all are
        /// lent, which is freed afterwards. Of fewer, those that are too many are freed as they are given back.
        /// </summary>
        public static int MaxContexts
        {
            get => Options.MaxContexts;
            set => Options.MaxContexts = value >= 1
                ? value
                : throw new ArgumentOutOfRangeException(nameof(value), value, "at least one context is needed");
        }

        /// <summary>
        /// CPU threads of each context made from now on, at most 4096; default: one less than there are, so that the
        /// game keeps one, but at least two. 0: all.
        /// </summary>
        public static uint Threads { get => Options.Threads; set => Options.Threads = value; }

        /// <summary>
        /// Bytes of work memory for each context made from now on (<see cref="SurfaceContextOptions.MemoryBudget"/>);
        /// 0 (default): what is free.
        /// </summary>
        public static ulong MemoryBudget { get => Options.MemoryBudget; set => Options.MemoryBudget = value; }

        /// <summary>CUDA device of contexts made from now on; default 0.</summary>
        public static int Device
        {
            get => Options.Device;
            set => Options.Device = value >= 0
                ? value
                : throw new ArgumentOutOfRangeException(nameof(value), value, "devices count from 0");
        }

        // Read when they are first asked for: assets can't be loaded whenever statics are made.
        private static ref SchedulerOptions Options
        {
            get
            {
                if (!s_areOptionsRead)
                {
                    s_options = SchedulerOptions.Default;
                    ReadProjectOptions(ref s_options);
                    s_projectOptions = s_options;
                    s_areOptionsRead = true;
                }
                return ref s_options;
            }
        }

        /// <summary>What scripts have set is forgotten: the options are those of the project again.</summary>
        internal static void ResetOptions()
        {
            s_areOptionsRead = false;
            GpuMeshPlan = default;
            GpuDelivery.ChooseAgain();
        }

        /// <summary>
        /// The options of the project may have been edited: if so, they hold from now on, in place of what scripts have set.
        /// </summary>
        internal static void FollowProjectOptions()
        {
            if (!s_areOptionsRead)
                return;
            SchedulerOptions project = SchedulerOptions.Default;
            ReadProjectOptions(ref project);
            if (project.Equals(s_projectOptions))
                return;
            ResetOptions();
            ReleaseInBackground(); // contexts have the options they were made with
        }

        static partial void ReadProjectOptions(ref SchedulerOptions options);
    }
}
