// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    /// <summary>Of a mesh, until that gets other buffers.</summary>
    public sealed unsafe class GraphicsBuffer : IDisposable
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

        private readonly int _name;

        internal GraphicsBuffer(int name) => _name = name;

        /// <summary>Waits for all that was asked of the thread that draws.</summary>
        public void GetData(Array data, int managedBufferStartIndex, int computeBufferStartIndex, int count)
        {
            if (RenderThread.IsRunning)
                RenderThread.Run();
            if (!GraphicsMemory.TryFind(_name, out _, out Span<byte> bytes))
                throw new ArgumentException("The buffer is not there any more.");
            int size = Buffer.ByteLength(data) / Math.Max(1, data.Length);
            GCHandle pin = GCHandle.Alloc(data, GCHandleType.Pinned);
            bytes.Slice(size * computeBufferStartIndex, size * count).CopyTo(new Span<byte>(
                (byte*)pin.AddrOfPinnedObject() + size * managedBufferStartIndex, size * count));
            pin.Free();
        }

        public void Dispose()
        {
        }
    }
}
