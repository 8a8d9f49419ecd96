// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

namespace UnityEngine
{
    /// <summary>A perspective camera of a screen of 1280 x 720 pixels.</summary>
    public sealed class Camera : Behaviour
    {
        public static Camera main
        {
            get
            {
                foreach (Object item in ObjectRegistry.Objects)
                    if (item is Camera camera && camera.gameObject.tag == "MainCamera" && camera.isActiveAndEnabled)
                        return camera;
                return null;
            }
        }

        public float fieldOfView { get; set; } = 60;

        public float nearClipPlane { get; set; } = 0.3f;

        public float farClipPlane { get; set; } = 1000;

        public float aspect { get; set; } = 1280f / 720;

        public Color backgroundColor { get; set; }

        internal override void CopyStateOf(Component original)
        {
            base.CopyStateOf(original);
            var other = (Camera)original;
            (fieldOfView, nearClipPlane, farClipPlane) = (other.fieldOfView, other.nearClipPlane, other.farClipPlane);
            (aspect, backgroundColor) = (other.aspect, other.backgroundColor);
        }

        public Ray ScreenPointToRay(Vector3 pos)
        {
            float height = Mathf.Tan(fieldOfView / 2 * Mathf.Deg2Rad);
            var direction = new Vector3((pos.x / 640 - 1) * height * aspect, (pos.y / 360 - 1) * height, 1);
            return new Ray(transform.position, transform.TransformDirection(direction));
        }
    }

    public static class Screen
    {
        public static int width => 1280;

        public static int height => 720;
    }
}
