// SPDX-License-Identifier: MIT
// What the engine has to do with it.
using QuickSes.Interop;
using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes
{
    internal static partial class GpuDelivery
    {
        static partial void AskEngine(ref GpuGraphics graphics, ref string name)
        {
            GraphicsDeviceType type = SystemInfo.graphicsDeviceType;
            graphics = type == GraphicsDeviceType.OpenGLCore ? GpuGraphics.Opengl :
                type == GraphicsDeviceType.Direct3D11 ? GpuGraphics.D3d11 : default;
            name = type.ToString();
        }

        static partial void IssueInEngine(IntPtr function, int number) => GL.IssuePluginEvent(function, number);
    }
}
