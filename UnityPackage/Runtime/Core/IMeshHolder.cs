// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>Whose memory a <see cref="SurfaceMeshView"/> looks at.</summary>
    internal interface IMeshHolder
    {
        /// <summary>Whether views of this generation may still be looked at.</summary>
        bool IsCurrent(int generation);

        void ThrowIfDisposed();
    }
}
