// SPDX-License-Identifier: MIT
using System;
using System.Text;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;

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

        public long dataSize
        {
            get
            {
                RequireAlive("get_dataSize");
                return _data.Length;
            }
        }

        /// <summary>The memory of the asset itself, which goes with it.</summary>
        public unsafe NativeArray<T> GetData<T>() where T : struct
        {
            RequireAlive("GetData");
            int size = UnsafeUtility.SizeOf<T>();
            if (_data.Length % size != 0)
                throw new ArgumentException($"Type passed to {nameof(GetData)} can't capture the asset data. Data " +
                    $"size is {_data.Length} which is not a multiple of type size {size}");
            NativeArray<T> view = NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<T>(
                _data._buffer, _data.Length / size, Allocator.None);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, _data._safety);
#endif
            return view;
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
