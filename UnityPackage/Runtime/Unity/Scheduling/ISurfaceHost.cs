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

        /// <summary>Milliseconds per surface while atoms move; 0: all levels.</summary>
        float FrameBudget { get; }

        /// <summary>Seconds without a change until what is shown is refined.</summary>
        float RestDelay { get; }

        /// <summary>What is computed in the end.</summary>
        /// <param name="levels">Coarser levels, Å, as the user gave them; those of the settings don't count.</param>
        SurfaceSettings MakeSettings(out ReadOnlySpan<float> levels);

        /// <summary>Shows a surface; throws if it can't.</summary>
        /// <param name="mesh">Valid during the call.</param>
        /// <param name="report">Of this mesh.</param>
        /// <param name="ladder">Of all levels.</param>
        /// <param name="isOfNewestAtoms">And of the newest settings and colours.</param>
        SurfaceLevel Show(in SurfaceMeshView mesh, in SurfaceReport report, ReadOnlySpan<float> ladder,
            bool isOfNewestAtoms);

        void OnUpdated(in SurfaceLevel level);

        void OnFinished();

        void OnFailed(in QuickSesError error);

        /// <summary>The session has ended: nothing is shown any more.</summary>
        void OnDisposed();
    }
}
