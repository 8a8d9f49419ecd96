// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>What happens at the ends of a trajectory.</summary>
    public enum PlaybackMode
    {
        /// <summary>It starts anew from the other end.</summary>
        Loop = 0,
        /// <summary>It turns round.</summary>
        PingPong = 1,
        /// <summary>It stops at the end: on the last frame, with a negative rate on the first.</summary>
        Once = 2
    }
}
