// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;

namespace UnityEngine
{
    public enum FilterMode
    {
        Point = 0,
        Bilinear = 1,
        Trilinear = 2
    }

    public enum TextureWrapMode
    {
        Repeat = 0,
        Clamp = 1,
        Mirror = 2,
        MirrorOnce = 3
    }

    public enum TextureFormat
    {
        RGBA32 = 4
    }

    public class Texture : Object
    {
        public virtual int width { get; protected set; }

        public virtual int height { get; protected set; }

        public FilterMode filterMode { get; set; } = FilterMode.Bilinear;

        public TextureWrapMode wrapMode { get; set; }
    }

    /// <summary>Of RGBA32, readable, without mipmaps: what is set is seen by shaders after Apply.</summary>
    public sealed unsafe class Texture2D : Texture
    {
        private static Texture2D s_white;

        private readonly uint[] _set;
        private readonly uint[] _applied;

        public Texture2D(int width, int height, TextureFormat textureFormat, bool mipChain, bool linear)
        {
            EngineThread.Require("Texture2D");
            if (width < 1 || height < 1 || width > SystemInfo.maxTextureSize || height > SystemInfo.maxTextureSize)
                throw new UnityException("Failed to create texture because of invalid parameters.");
            if (textureFormat != TextureFormat.RGBA32 || mipChain)
                throw new NotSupportedException("The double has RGBA32 without mipmaps only.");
            this.width = width;
            this.height = height;
            IsLinear = linear;
            _set = new uint[width * height];
            _applied = new uint[width * height];
        }

        public static Texture2D whiteTexture
        {
            get
            {
                if (s_white == null)
                    s_white = new Texture2D(4, 4, TextureFormat.RGBA32, false, false);
                return s_white;
            }
        }

        /// <summary>Whether shaders read the bytes as they are; only in the double.</summary>
        public bool IsLinear { get; }

        /// <summary>Bytes that Apply has moved; only in the double.</summary>
        public long BytesApplied { get; private set; }

        /// <summary>What was applied, row after row, the lowest first; makes a new array.</summary>
        public Color32[] GetPixels32()
        {
            RequireAlive("GetPixels32");
            var pixels = new Color32[_applied.Length];
            fixed (uint* from = _applied)
            fixed (Color32* to = pixels)
                Buffer.MemoryCopy(from, to, 4L * pixels.Length, 4L * pixels.Length);
            return pixels;
        }

        public void SetPixelData<T>(NativeArray<T> data, int mipLevel, int sourceDataStartIndex = 0) where T : struct
        {
            RequireAlive("SetPixelData");
            if (sourceDataStartIndex < 0)
                throw new UnityException("SetPixelData: sourceDataStartIndex cannot be less than 0.");
            if (data.Length == 0)
                throw new UnityException("No texture data provided to SetPixelData.");
            long size = UnsafeUtility.SizeOf<T>(), bytes = 4L * _set.Length;
            if (mipLevel != 0 || (data.Length - sourceDataStartIndex) * size < bytes)
                throw new UnityException("SetPixelData: not enough data provided (will result in overread).");
            fixed (uint* to = _set)
                Buffer.MemoryCopy(
                    (byte*)data.GetUnsafeReadOnlyPtr() + sourceDataStartIndex * size, to, bytes, bytes);
        }

        public void Apply(bool updateMipmaps, bool makeNoLongerReadable)
        {
            RequireAlive("Apply");
            _set.CopyTo(_applied, 0);
            BytesApplied += 4L * _set.Length;
            MeshRecord.AllBytesUploaded += 4L * _set.Length;
        }
    }
}
