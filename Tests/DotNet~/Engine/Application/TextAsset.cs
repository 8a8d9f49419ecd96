// SPDX-License-Identifier: MIT
using System.Text;
using Unity.Collections;

namespace UnityEngine
{
    /// <summary>
    /// The bytes lie in unmanaged memory until the asset is destroyed; each <see cref="bytes"/> is a copy.
    /// </summary>
    public class TextAsset : Object
    {
        private NativeArray<byte> _data;

        public TextAsset() : this("")
        {
        }

        public TextAsset(string text) : this(Encoding.UTF8.GetBytes(text ?? ""))
        {
        }

        internal TextAsset(byte[] bytes) => _data = new NativeArray<byte>(bytes, Allocator.Persistent);

        public byte[] bytes
        {
            get
            {
                RequireAlive("get_bytes");
                return _data.ToArray();
            }
        }

        public string text
        {
            get
            {
                byte[] all = bytes;
                bool isMarked = all.Length >= 3 && all[0] == 0xef && all[1] == 0xbb && all[2] == 0xbf;
                return isMarked ? Encoding.UTF8.GetString(all, 3, all.Length - 3) : Encoding.UTF8.GetString(all);
            }
        }

        public override string ToString() => text;

        internal override void OnDestroying() => _data.Dispose();
    }
}
