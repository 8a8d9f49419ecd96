// SPDX-License-Identifier: MIT
using System;
using System.Threading;

namespace QuickSes.Editor
{
    /// <summary>
    /// Asks how a back end stands. A thread of the pool waits for the answer, since the first question starts CUDA; who
    /// asks looks for it later. No Editor in here.
    /// </summary>
    internal sealed class BackendInquiry
    {
        private static readonly WaitCallback s_find = inquiry => ((BackendInquiry)inquiry).Find();

        private readonly SurfaceBackend _backend;
        private readonly object _lock = new object();
        private bool _isAsked;
        private bool _isAnswered;
        private BackendDescription _answer;

        public BackendInquiry(SurfaceBackend backend)
        {
            _backend = backend;
        }

        /// <summary>Asks, unless a question is under way.</summary>
        public void Ask()
        {
            lock (_lock)
            {
                if (_isAsked)
                    return;
                _isAsked = true;
            }
            ThreadPool.UnsafeQueueUserWorkItem(s_find, this);
        }

        /// <summary>The last answer, if there is one.</summary>
        public bool TryGetAnswer(out BackendDescription answer)
        {
            lock (_lock)
            {
                answer = _answer;
                return _isAnswered;
            }
        }

        private void Find()
        {
            BackendDescription found = default;
            try
            {
                found = SurfaceContext.GetBackendDescription(_backend);
            }
            catch (Exception) // no library, or no memory: nothing is known; on a thread of the pool it would end the Editor
            {
            }
            lock (_lock)
            {
                _answer = found;
                _isAnswered = true;
                _isAsked = false;
            }
        }
    }
}
