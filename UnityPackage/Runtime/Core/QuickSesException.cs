// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// A call that its caller could have known to be wrong, such as a position that is not a number, a setting out of
    /// range or a computation without atoms. What depends on the machine, the size of the molecule or the content of
    /// files is told by a <see cref="QuickSesStatus"/> instead. Whatever threw it is still usable, and the last mesh
    /// valid.
    /// </summary>
    public sealed class QuickSesException : Exception
    {
        internal QuickSesException(QuickSesStatus status, string message) : base(message)
        {
            Status = status;
        }

        /// <summary>The native library's verdict.</summary>
        public QuickSesStatus Status { get; }

        internal static QuickSesException FromLastCall(QuickSesStatus status) =>
            new QuickSesException(status, NativeText.LastError());

        internal static void ThrowUnlessOk(QuickSesStatus status)
        {
            if (status != QuickSesStatus.Ok)
                throw FromLastCall(status);
        }
    }
}
