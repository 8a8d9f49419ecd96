// SPDX-License-Identifier: MIT
#if ENABLE_UNITY_COLLECTIONS_CHECKS // As in the engine: the type doesn't exist in players.
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Runtime.InteropServices;

namespace Unity.Collections.LowLevel.Unsafe
{
    /// <summary>
    /// Refers to a node in unmanaged memory that outlives all handles to it; a node is used again after Release, with
    /// another version, so that handles of its former life are known to be stale.
    /// </summary>
    public unsafe struct AtomicSafetyHandle
    {
        private struct Node
        {
            public int Version;
            public int SecondaryVersion;
            public bool SecondaryIsWritable;
            public bool IsLive;
        }

        private static readonly Stack<IntPtr> s_released = new Stack<IntPtr>(256);

        private Node* _node;
        private int _version;
        private bool _isSecondary;

        public static AtomicSafetyHandle Create()
        {
            lock (s_released)
            {
                Node* node;
                if (s_released.Count > 0)
                {
                    node = (Node*)s_released.Pop();
                }
                else
                {
                    node = (Node*)Marshal.AllocHGlobal(sizeof(Node));
                    *node = default;
                }

                ++node->Version;
                node->SecondaryVersion = node->Version;
                node->SecondaryIsWritable = node->IsLive = true;
                return new AtomicSafetyHandle { _node = node, _version = node->Version };
            }
        }

        public static void Release(AtomicSafetyHandle handle)
        {
            lock (s_released)
            {
                if (!handle.Exists)
                    throw new InvalidOperationException("The AtomicSafetyHandle is not alive: it can't be released.");
                ++handle._node->Version;
                ++handle._node->SecondaryVersion;
                handle._node->IsLive = false;
                s_released.Push(new IntPtr(handle._node));
            }
        }

        public static void UseSecondaryVersion(ref AtomicSafetyHandle handle)
        {
            handle.RequireNode();
            handle._isSecondary = true;
            handle._version = handle._node->SecondaryVersion;
        }

        public static void SetAllowSecondaryVersionWriting(AtomicSafetyHandle handle, bool allowWriting)
        {
            handle.RequireNode();
            handle._node->SecondaryIsWritable = allowWriting;
        }

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckReadAndThrow(AtomicSafetyHandle handle) => handle.RequireExistence();

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckWriteAndThrow(AtomicSafetyHandle handle)
        {
            handle.RequireExistence();
            if (handle._isSecondary && !handle._node->SecondaryIsWritable)
                throw new InvalidOperationException("The native array is read-only: it can't be written to.");
        }

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckDeallocateAndThrow(AtomicSafetyHandle handle) =>
            handle.RequireExistence();

        private bool Exists => _node != null && _node->IsLive &&
            _version == (_isSecondary ? _node->SecondaryVersion : _node->Version);

        // The engine follows the null pointer.
        private void RequireNode()
        {
            if (_node == null)
                throw new NullReferenceException(
                    "A native array without an AtomicSafetyHandle is accessed; the Editor follows a null pointer.");
        }

        private void RequireExistence()
        {
            RequireNode();
            if (!Exists)
                throw new ObjectDisposedException(null,
                    "The native array has been disposed, or was invalidated: it is not allowed to access it.");
        }
    }
}
#endif
