// SPDX-License-Identifier: MIT
using System;

namespace Unity.Collections
{
    public unsafe partial struct NativeArray<T>
    {
        public static void Copy(T[] src, NativeArray<T> dst)
        {
            RequireEqualLengths(src.Length, dst._length);
            Copy(src, 0, dst, 0, src.Length);
        }

        public static void Copy(NativeArray<T> src, T[] dst)
        {
            RequireEqualLengths(src._length, dst.Length);
            Copy(src, 0, dst, 0, src._length);
        }

        public static void Copy(T[] src, int srcIndex, NativeArray<T> dst, int dstIndex, int length)
        {
            dst.RequireWritable();
            if (src == null)
                throw new ArgumentNullException(nameof(src));
            RequireRanges(src.Length, srcIndex, dst._length, dstIndex, length);
            src.AsSpan(srcIndex, length).CopyTo(dst.Span.Slice(dstIndex));
        }

        public static void Copy(NativeArray<T> src, int srcIndex, T[] dst, int dstIndex, int length)
        {
            src.RequireReadable();
            if (dst == null)
                throw new ArgumentNullException(nameof(dst));
            RequireRanges(src._length, srcIndex, dst.Length, dstIndex, length);
            src.Span.Slice(srcIndex, length).CopyTo(dst.AsSpan(dstIndex));
        }

        // The engine has no such thing before 2022.
        internal readonly Span<T> Span => new Span<T>(_buffer, _length);

        private static void RequireEqualLengths(int source, int destination)
        {
            if (source != destination)
                throw new ArgumentException("source and destination length must be the same");
        }

        // An index at the end of an array that isn't empty is refused even for a length of 0, as in the Editor.
        private static void RequireRanges(int srcLength, int srcIndex, int dstLength, int dstIndex, int length)
        {
            if (length < 0)
                throw new ArgumentOutOfRangeException(nameof(length), "length must be equal or greater than zero.");
            if (srcIndex < 0 || srcIndex > srcLength || (srcIndex == srcLength && srcLength > 0))
                throw new ArgumentOutOfRangeException(nameof(srcIndex), "srcIndex is outside the source array.");
            if (dstIndex < 0 || dstIndex > dstLength || (dstIndex == dstLength && dstLength > 0))
                throw new ArgumentOutOfRangeException(nameof(dstIndex), "dstIndex is outside the destination array.");
            if ((long)srcIndex + length > srcLength)
                throw new ArgumentException("length goes beyond the end of the source array.", nameof(length));
            if ((long)dstIndex + length > dstLength)
                throw new ArgumentException("length goes beyond the end of the destination array.", nameof(length));
        }
    }
}
