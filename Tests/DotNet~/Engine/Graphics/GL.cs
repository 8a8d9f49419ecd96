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
}
