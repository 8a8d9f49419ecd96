// SPDX-License-Identifier: MIT
using System;
using System.Text;

namespace QuickSes.Interop
{
    /// <summary>Text as the library gives and takes it: UTF-8 that ends with a zero.</summary>
    internal static unsafe class NativeText
    {
        public static string Read(byte* text)
        {
            if (text == null)
                return "";
            int length = 0;
            while (text[length] != 0)
                ++length;
            return Encoding.UTF8.GetString(text, length);
        }

        /// <summary>null stays null.</summary>
        public static byte[] Write(string text, string argument)
        {
            if (text == null)
                return null;
            if (text.IndexOf('\0') >= 0)
                throw new ArgumentException("contains a zero character", argument);
            var bytes = new byte[Encoding.UTF8.GetByteCount(text) + 1];
            Encoding.UTF8.GetBytes(text, 0, text.Length, bytes, 0);
            return bytes;
        }

        /// <summary>What went wrong in the last call on this thread.</summary>
        public static string LastError() => Read(NativeMethods.qses_last_error());
    }
}
