// SPDX-License-Identifier: MIT
using UnityEngine.Rendering;

namespace UnityEngine
{
    public sealed class SystemInfo
    {
        public static string graphicsDeviceName => "The double of a GPU";

        public static int maxTextureSize => 16384;

        /// <summary>What the machine draws with; only the double sets it.</summary>
        public static GraphicsDeviceType GraphicsDevice { get; set; } = GraphicsDeviceType.OpenGLCore;

        public static GraphicsDeviceType graphicsDeviceType => GraphicsDevice;

        /// <summary>What the machine has; only the double sets it.</summary>
        public static bool HasIntegerAttributes { get; set; } = true;

        public static bool SupportsVertexAttributeFormat(VertexAttributeFormat format, int dimension) =>
            HasIntegerAttributes || format < VertexAttributeFormat.UInt8;
    }
}
