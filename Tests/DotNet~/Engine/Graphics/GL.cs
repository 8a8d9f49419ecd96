// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;

namespace UnityEngine
{
    public sealed class GL
    {
        /// <summary>The thread that draws calls it later, in the order of all that is drawn.</summary>
        public static void IssuePluginEvent(IntPtr callback, int eventID)
        {
            if (callback == IntPtr.Zero)
                throw new ArgumentException("Null callback specified.", nameof(callback));
            RenderThread.Add(callback, eventID);
        }
    }

    public sealed class GraphicsBuffer
    {
        [Flags]
        public enum Target
        {
            Vertex = 1 << 0,
            Index = 1 << 1,
            CopySource = 1 << 2,
            CopyDestination = 1 << 3,
            Structured = 1 << 4,
            Raw = 1 << 5,
            Append = 1 << 6,
            Counter = 1 << 7,
            IndirectArguments = 1 << 8,
            Constant = 1 << 9
        }
    }
}
