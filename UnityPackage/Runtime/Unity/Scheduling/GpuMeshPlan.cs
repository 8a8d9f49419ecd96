// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>
    /// How the engine is told what to draw of buffers it has not filled itself. Which of them it bears is not documented:
    /// the sample <i>GPU delivery check</i> finds out.
    /// </summary>
    public enum GpuMeshPlan
    {
        /// <summary>Each surface sets counts and bounds of the submesh.</summary>
        SubMeshPerFrame = 0,
        /// <summary>
        /// The submesh is all of the index buffer, whose rest is zeros, and stays so; bounds are those of the renderer
        /// (Renderer.localBounds). The mesh is touched only when it is made.
        /// </summary>
        WholeBuffers = 1
    }
}
