// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// The buffers that the graphics API has, by their names: what <see cref="UnityEngine.Mesh.GetNativeVertexBufferPtr"/>
    /// gives. They are the memory of the meshes themselves. As with OpenGL, names of buffers that are gone come again.
    /// </summary>
    public static unsafe class GraphicsMemory
    {
        private static readonly SortedSet<int> s_free = new SortedSet<int>();
        private static readonly Dictionary<int, Entry> s_buffers = new Dictionary<int, Entry>();
        private static long s_made;

        /// <summary>A buffer is being deleted; its identity.</summary>
        public static event Action<long> Deleting;

        /// <summary>If not null, the graphics API gives no buffers any more.</summary>
        public static string Refusal { get; set; }

        /// <summary>False: there is no such buffer.</summary>
        /// <param name="name">Its name.</param>
        /// <param name="identity">A number that no other buffer has or will have.</param>
        /// <param name="bytes">What is in it; ends with the buffer.</param>
        public static bool TryFind(long name, out long identity, out Span<byte> bytes)
        {
            bool isThere = s_buffers.TryGetValue((int)name, out Entry entry);
            identity = entry.Identity;
            bytes = new Span<byte>((void*)entry.Memory, (int)entry.Size);
            return isThere;
        }

        internal static int Add(IntPtr memory, long size)
        {
            if (Refusal != null)
                throw new InvalidOperationException(Refusal);
            int name = s_free.Count > 0 ? s_free.Min : s_buffers.Count + 1;
            s_free.Remove(name);
            s_buffers[name] = new Entry { Memory = memory, Size = size, Identity = ++s_made };
            return name;
        }

        internal static void Forget(ref int name)
        {
            if (name == 0)
                return;
            Deleting?.Invoke(s_buffers[name].Identity);
            s_buffers.Remove(name);
            s_free.Add(name);
            name = 0;
        }

        private struct Entry
        {
            public IntPtr Memory;
            public long Size, Identity;
        }
    }
}
