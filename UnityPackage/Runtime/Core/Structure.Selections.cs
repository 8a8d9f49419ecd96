// SPDX-License-Identifier: MIT
// Which of its atoms a selection names: words such as "protein and chain A", or CID such as "//A/10-40"; "": all. Atoms
// that were left out when the file was read are not found.
using QuickSes.Interop;
using System;
using System.Text;

namespace QuickSes
{
    public sealed unsafe partial class Structure
    {
        private const int TextOnStack = 256; // bytes

        /// <summary>The atoms that a selection names, rising; maybe none. Makes an array.</summary>
        /// <exception cref="QuickSesException">
        /// The selection can't be understood, or the file has no names (XYZR).
        /// </exception>
        public int[] Select(string selection)
        {
            var selected = new bool[AtomCount];
            if (!TrySelect(selection, selected, out int count, out QuickSesError error))
                throw new QuickSesException(error.Status, error.Message);
            var indices = new int[count];
            for (int i = 0, k = 0; k < count; ++i)
                if (selected[i])
                    indices[k++] = i;
            return indices;
        }

        /// <summary>
        /// Which atoms a selection names. Makes no garbage unless it fails.
        /// </summary>
        /// <param name="selection">Words or CID; "": all.</param>
        /// <param name="selected">Room for N; atoms that are named become true, others false.</param>
        /// <param name="count">How many are named.</param>
        /// <param name="error">Why not: the selection can't be understood, or the file has no names (XYZR).</param>
        /// <returns>Whether it was understood; else <paramref name="selected"/> stays as it was.</returns>
        public bool TrySelect(string selection, Span<bool> selected, out int count, out QuickSesError error)
        {
            if (selection == null)
                throw new ArgumentNullException(nameof(selection));
            if (selection.IndexOf('\0') >= 0)
                throw new ArgumentException("contains a zero character", nameof(selection));
            if (selected.Length != AtomCount)
                throw new ArgumentException($"has {selected.Length} elements for {AtomCount} atoms", nameof(selected));
            int length = Encoding.UTF8.GetByteCount(selection);
            Span<byte> text = length < TextOnStack ? stackalloc byte[TextOnStack] : new byte[length + 1];
            Encoding.UTF8.GetBytes(selection, text);
            text[length] = 0;
            uint found;
            QuickSesStatus status;
            fixed (byte* cid = text)
            fixed (bool* mask = selected)
                status = NativeMethods.qses_structure_select(_handle, cid, (byte*)mask, (UIntPtr)selected.Length, &found);
            error = QuickSesError.FromLastCall(status);
            count = status == QuickSesStatus.Ok ? (int)found : 0;
            return status == QuickSesStatus.Ok;
        }
    }
}
