// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>How surfaces get from the GPU that computes them to the GPU that draws them.</summary>
    public enum SurfaceDelivery
    {
        /// <summary>On the GPU where that is known to be possible and worth it, else by host memory.</summary>
        Auto = 0,
        /// <summary>By host memory, which works everywhere.</summary>
        Host = 1,
        /// <summary>On the GPU wherever it can be tried, whatever the size; else by host memory.</summary>
        Device = 2
    }
}
