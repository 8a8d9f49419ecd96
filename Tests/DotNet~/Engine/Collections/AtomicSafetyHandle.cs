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
            public bool IsAccessible;
            public bool IsUndisposable;
            public bool IsLive;
        }

        private static readonly Stack<IntPtr> s_released = new Stack<IntPtr>(256);
        private static AtomicSafetyHandle s_temporary;
        private static int s_liveCount;

        private Node* _node;
        private int _version;
        private bool _isSecondary;

        /// <summary>Handles that were created and not released.</summary>
        internal static int LiveCount
        {
            get { lock (s_released) return s_liveCount; }
        }

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
                node->SecondaryIsWritable = node->IsAccessible = node->IsLive = true;
                node->IsUndisposable = false;
                ++s_liveCount;
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
                --s_liveCount;
            }
        }

        public static AtomicSafetyHandle GetTempMemoryHandle()
        {
            if (s_temporary._node == null)
            {
                s_temporary = Create();
                --s_liveCount;
            }

            return s_temporary;
        }

        public static AtomicSafetyHandle GetTempUnsafePtrSliceHandle() => GetTempMemoryHandle();

        public static bool IsTempMemoryHandle(AtomicSafetyHandle handle) =>
            handle._node != null && handle._node == s_temporary._node;

        public static bool IsDefaultValue(in AtomicSafetyHandle handle) => handle._node == null;

        public static bool IsHandleValid(in AtomicSafetyHandle handle)
        {
            handle.RequireNode();
            return handle.Exists;
        }

        public static bool IsValidNonDefaultHandle(in AtomicSafetyHandle handle) =>
            !IsDefaultValue(handle) && handle.Exists;

        public static void PrepareUndisposable(ref AtomicSafetyHandle handle) => handle._node->IsUndisposable = true;

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

        public static void SetBumpSecondaryVersionOnScheduleWrite(AtomicSafetyHandle handle, bool value) =>
            handle.RequireNode();

        public static void SetAllowReadOrWriteAccess(AtomicSafetyHandle handle, bool allowReadWriteAccess)
        {
            handle.RequireNode();
            handle._node->IsAccessible = allowReadWriteAccess;
        }

        public static bool GetAllowReadOrWriteAccess(AtomicSafetyHandle handle)
        {
            handle.RequireNode();
            return handle._node->IsAccessible;
        }

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckReadAndThrow(AtomicSafetyHandle handle) => handle.RequireAccess();

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckWriteAndThrow(AtomicSafetyHandle handle)
        {
            handle.RequireAccess();
            if (handle._isSecondary && !handle._node->SecondaryIsWritable)
                throw new InvalidOperationException("The native array is read-only: it can't be written to.");
        }

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckWriteAndBumpSecondaryVersion(AtomicSafetyHandle handle)
        {
            CheckWriteAndThrow(handle);
            ++handle._node->SecondaryVersion;
        }

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckGetSecondaryDataPointerAndThrow(AtomicSafetyHandle handle) => handle.RequireAccess();

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckDeallocateAndThrow(AtomicSafetyHandle handle)
        {
            handle.RequireExistence();
            if (handle._node->IsUndisposable)
                throw new InvalidOperationException("The native array must not be disposed.");
        }

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void CheckExistsAndThrow(in AtomicSafetyHandle handle) => handle.RequireExistence();

        [Conditional("ENABLE_UNITY_COLLECTIONS_CHECKS")]
        public static void ValidateNonDefaultHandle(in AtomicSafetyHandle handle)
        {
            if (!IsDefaultValue(handle))
                handle.RequireExistence();
        }

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

        private void RequireAccess()
        {
            RequireExistence();
            if (!_node->IsAccessible)
                throw new InvalidOperationException("Access to the native array is not allowed now.");
        }
    }
}
#endif
