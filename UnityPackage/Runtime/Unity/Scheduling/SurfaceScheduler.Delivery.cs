// SPDX-License-Identifier: MIT
// How surfaces get to the GPU that draws them.
using System;

namespace QuickSes
{
    public static partial class SurfaceScheduler
    {
        /// <summary>
        /// Whether surfaces that CUDA computes stay on the GPU; default Host, since no Editor has run it yet.
        /// <para>Auto: those of more than 5 MB, with OpenGLCore. Device: all, with OpenGLCore and Direct3D11. Where it is
        /// not possible or fails, surfaces come by host memory as ever, and <see cref="MolecularSurface.DeliveryReason"/>
        /// says why. Setting it lets surfaces for which it failed try again. In C# the mesh of a surface that stays on the
        /// GPU is not filled: see <see cref="MolecularSurface.UsedDelivery"/>.</para>
        /// <para>Host holds from the next LateUpdate on: surfaces on the GPU are downloaded there, which blocks, and
        /// uploaded. The others hold from the next computation on.</para>
        /// </summary>
        public static SurfaceDelivery Delivery
        {
            get => Options.Delivery;
            set
            {
                if (value < SurfaceDelivery.Auto || value > SurfaceDelivery.Device)
                    throw new ArgumentOutOfRangeException(nameof(value), value, "is no SurfaceDelivery");
                Options.Delivery = value;
                GpuDelivery.ChooseAgain();
            }
        }

        /// <summary>
        /// How meshes that stay on the GPU are drawn; default SubMeshPerFrame. May be changed at any time.
        /// </summary>
        public static GpuMeshPlan GpuMeshPlan { get; set; }

        /// <summary>
        /// What is there of all surfaces goes on its way, by one event: as the first thing in a frame, so that it is drawn
        /// in it.
        /// </summary>
        internal static void Deliver()
        {
            if (Delivery == SurfaceDelivery.Host && GpuDelivery.Targets == 0)
                return;
            foreach (SurfaceSession session in s_sessions)
                session.Deliver();
            if (GpuDelivery.Targets > 0)
                GpuDelivery.Issue();
        }
    }
}
