// SPDX-License-Identifier: MIT
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// The project's options of <see cref="SurfaceScheduler"/>: an asset of this name in a folder called Resources, so that
    /// builds have it too. Edit > Project Settings > QuickSES makes and edits it; without it the defaults hold. What
    /// scripts set at run time overrides it, until play mode begins again, or the settings are edited.
    /// </summary>
    public sealed class QuickSesSettings : ScriptableObject
    {
        /// <summary>The name of the asset, without extension, in any folder called Resources.</summary>
        public const string AssetName = "QuickSesSettings";

        private const ulong BytesPerMegabyte = 1000000;

        [SerializeField, Min(1), Tooltip("The most contexts per back end. Each keeps memory for its largest surface; more " +
            "let more surfaces be computed at a time.")]
        private int _maxContexts = 4;
        [SerializeField, Min(0), Tooltip("CPU threads of each context. 0: one less than there are processors, but at " +
            "least two.")]
        private int _threads;
        [SerializeField, Min(0), Tooltip("Megabytes of work memory of each context. 0: what is free. Smaller budgets take " +
            "longer and give the same mesh.")]
        private int _memoryBudget;
        [SerializeField, Min(0), Tooltip("Number of the CUDA device, from 0.")]
        private int _device;
        [SerializeField, Min(0), Tooltip("Milliseconds per frame that all surfaces together may take to be copied into " +
            "meshes. 0: no limit. What does not fit comes in later frames.")]
        private float _uploadBudget = 2;
        [SerializeField, Tooltip("Whether surfaces that CUDA computes stay on the GPU. Host: no. Auto: large ones, with " +
            "OpenGLCore. Device: all, with OpenGLCore and Direct3D11. Not tried in an Editor yet: see the sample GPU " +
            "delivery check.")]
        private SurfaceDelivery _delivery = SurfaceDelivery.Host;

        /// <summary>The project's; null: there is none, and the defaults hold. Main thread only.</summary>
        public static QuickSesSettings Find() => Resources.Load<QuickSesSettings>(AssetName);

#if UNITY_EDITOR
        // The inspector, Undo, a preset or version control wrote it, or it was loaded. Later, since assets can't be loaded
        // while values are validated.
        private void OnValidate()
        {
            UnityEditor.EditorApplication.delayCall -= SurfaceScheduler.FollowProjectOptions;
            UnityEditor.EditorApplication.delayCall += SurfaceScheduler.FollowProjectOptions;
        }
#endif

        // What files hold may be out of range.
        internal void CopyTo(ref SchedulerOptions options)
        {
            options.MaxContexts = Mathf.Max(_maxContexts, 1);
            options.Threads = _threads > 0 ? (uint)_threads : SchedulerOptions.DefaultThreads;
            options.MemoryBudget = (ulong)Mathf.Max(_memoryBudget, 0) * BytesPerMegabyte;
            options.Device = Mathf.Max(_device, 0);
            options.Delivery = _delivery >= SurfaceDelivery.Auto && _delivery <= SurfaceDelivery.Device
                ? _delivery
                : SurfaceDelivery.Host;
            options.UploadBudget = _uploadBudget >= 0 && !float.IsInfinity(_uploadBudget) ? _uploadBudget : 0;
        }
    }

    public static partial class SurfaceScheduler
    {
        static partial void ReadProjectOptions(ref SchedulerOptions options)
        {
            QuickSesSettings settings = QuickSesSettings.Find();
            if (settings != null)
                settings.CopyTo(ref options);
        }
    }
}
