// SPDX-License-Identifier: MIT
using UnityEngine;

namespace QuickSes.Samples
{
    /// <summary>Turns a camera round a point: drag to turn, wheel to come closer.</summary>
    [RequireComponent(typeof(Camera))]
    public sealed class OrbitCamera : MonoBehaviour
    {
        private const float DegreesPerPixel = 0.3f;
        private const float ZoomPerWheelStep = 0.03f;

        [SerializeField, Tooltip("Degrees round the vertical axis.")]
        private float _yaw;
        [SerializeField, Range(-89, 89), Tooltip("Degrees above the horizon.")]
        private float _pitch = 10;

        private Vector3 _center;
        private float _radius = 20;
        private float _distance = 60;

        /// <summary>Goes back so far that a sphere (world space) fits into the picture.</summary>
        public void LookAt(Vector3 center, float radius)
        {
            _center = center;
            _radius = Mathf.Max(radius, 0.01f);
            _distance = _radius / Mathf.Sin(0.5f * Mathf.Deg2Rad * GetComponent<Camera>().fieldOfView);
        }

        /// <summary>Takes the mouse events of OnGUI that nothing else has used.</summary>
        public void Handle(Event input)
        {
            switch (input.type)
            {
                case EventType.MouseDrag:
                    _yaw += DegreesPerPixel * input.delta.x;
                    _pitch = Mathf.Clamp(_pitch + DegreesPerPixel * input.delta.y, -89, 89);
                    input.Use();
                    break;
                case EventType.ScrollWheel:
                    float distance = _distance * Mathf.Exp(ZoomPerWheelStep * input.delta.y);
                    _distance = Mathf.Clamp(distance, 0.1f * _radius, 20 * _radius);
                    input.Use();
                    break;
            }
        }

        private void LateUpdate()
        {
            Quaternion rotation = Quaternion.Euler(_pitch, _yaw, 0);
            transform.SetPositionAndRotation(_center - rotation * new Vector3(0, 0, _distance), rotation);
        }
    }
}
