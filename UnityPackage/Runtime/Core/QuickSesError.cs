// SPDX-License-Identifier: MIT
using QuickSes.Interop;

namespace QuickSes
{
    /// <summary>Why something could not be opened or made: a status to decide by, a sentence to show.</summary>
    public readonly struct QuickSesError
    {
        internal QuickSesError(QuickSesStatus status, string message)
        {
            Status = status;
            _message = message;
        }

        private readonly string _message;

        /// <summary>Ok if nothing went wrong.</summary>
        public QuickSesStatus Status { get; }

        /// <summary>A sentence that names what is wrong; "" if nothing is. Never null.</summary>
        public string Message => _message ?? "";

        /// <summary>Status and sentence.</summary>
        public override string ToString() => Status == QuickSesStatus.Ok ? "Ok" : $"{Status}: {Message}";

        internal static QuickSesError FromLastCall(QuickSesStatus status) =>
            status == QuickSesStatus.Ok ? default : new QuickSesError(status, NativeText.LastError());

        internal QuickSesException ToException() => new QuickSesException(Status, Message);
    }
}
