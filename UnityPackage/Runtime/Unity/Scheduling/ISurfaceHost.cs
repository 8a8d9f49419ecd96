// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>
    /// Who shows the surface of a <see cref="SurfaceSession"/>: the settings it has chosen, and what it is told. Main
    /// thread only.
    /// </summary>
    internal interface ISurfaceHost
    {
        /// <summary>Whether it is gone, and could not say so.</summary>
        bool IsGone { get; }

        SurfaceBackend Backend { get; }

        /// <summary>The number of the engine's frame.</summary>
        int Frame { get; }

        /// <summary>Milliseconds per surface while atoms move; 0: all levels.</summary>
        float FrameBudget { get; }

        /// <summary>Seconds without a change until what is shown is refined.</summary>
        float RestDelay { get; }

        /// <summary>What is computed in the end.</summary>
        /// <param name="levels">Coarser levels, Å, as the user gave them; those of the settings don't count.</param>
        SurfaceSettings MakeSettings(out ReadOnlySpan<float> levels);

        /// <summary>
        /// Takes the mesh that a context has just collected (<see cref="SurfaceContext.Keep"/>) in the place of one it
        /// took before and has not begun to upload; throws if it can't.
        /// </summary>
        /// <param name="context">Has no mesh afterwards.</param>
        /// <param name="look">Of the atoms the mesh is of.</param>
        /// <param name="isMoving">Whether another one of about the same size is to be expected soon.</param>
        void Take(SurfaceContext context, AtomLook look, bool isMoving);

        /// <summary>Whether an upload of what was taken is under way, so that nothing newer can be taken.</summary>
        bool IsUploading { get; }

        /// <summary>Whether there is something to upload: what was taken, or another look of what is shown.</summary>
        bool HasUpload { get; }

        /// <summary>A step of it; throws if it fails.</summary>
        UploadStep Upload(in UploadShare share, out long bytes);

        /// <summary>
        /// Whether something on the GPU is on its way from there to there (and not to be uploaded): what was taken, or
        /// another look of what is shown.
        /// </summary>
        bool HasDelivery { get; }

        /// <summary>Whether it is to be asked for a delivery once per frame.</summary>
        bool UsesGpu { get; }

        /// <summary>
        /// How deliveries of the frames before have ended, and the next; what can't be delivered is to be uploaded
        /// afterwards. Who calls it lets an event be issued (<see cref="GpuDelivery.Issue"/>). Throws if it fails.
        /// </summary>
        /// <param name="isUrgent">Whether it is to be shown at once, or uploaded.</param>
        UploadStep Deliver(bool isUrgent);

        /// <summary>Why meshes of this surface are to be in host memory; "": they need not.</summary>
        string GpuRefusal { get; }

        /// <summary>They have to be, from now on.</summary>
        void RefuseGpu(string reason);

        /// <summary>Forgets what is not uploaded yet; what is shown stays.</summary>
        void DropUpload();

        /// <summary>Atoms have not moved for a while and what is shown is final: nothing is held ready any more.</summary>
        void Rest();

        void OnUpdated(in SurfaceLevel level);

        void OnFinished();

        void OnFailed(in QuickSesError error);

        /// <summary>The session has ended: nothing is shown any more.</summary>
        void OnDisposed();
    }
}
