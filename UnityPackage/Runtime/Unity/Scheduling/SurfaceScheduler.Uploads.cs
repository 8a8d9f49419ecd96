// SPDX-License-Identifier: MIT
// How surfaces share the main thread.
using System;

namespace QuickSes
{
    public static partial class SurfaceScheduler
    {
        private static readonly UploadQueue s_uploads = new UploadQueue();

        /// <summary>
        /// Milliseconds per frame that all surfaces together may take to be copied into meshes, measured; default 2. 0: no
        /// limit. What does not fit is shown in a later frame, the oldest first; a part of it goes through in every
        /// frame, so that nothing waits for ever. <see cref="MolecularSurface.ComputeNow"/> does not keep to it.
        /// </summary>
        public static double UploadBudget
        {
            get => Options.UploadBudget;
            set => Options.UploadBudget = value >= 0 && !double.IsInfinity(value)
                ? value
                : throw new ArgumentOutOfRangeException(nameof(value), value, "must be 0 ms or more");
        }

        /// <summary>Surfaces that wait to be copied into a mesh, or painted.</summary>
        public static int UploadingCount => s_uploads.Count;

        internal static UploadQueue Uploads
        {
            get
            {
                s_uploads.Budget = Options.UploadBudget;
                return s_uploads;
            }
        }
    }
}
