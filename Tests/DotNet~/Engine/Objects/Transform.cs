// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System.Collections.Generic;

namespace UnityEngine
{
    public class Transform : Component
    {
        private readonly List<Transform> _children = new List<Transform>();
        private Transform _parent;
        private Vector3 _localPosition;
        private Quaternion _localRotation = Quaternion.identity;
        private Vector3 _localScale = Vector3.one;

        internal Transform()
        {
        }

        internal GameObject ParentObject => _parent?.Owner;

        internal GameObject Root => _parent is null ? Owner : _parent.Root;

        public Transform parent
        {
            get
            {
                RequireAlive("get_parent");
                return _parent;
            }
            set => SetParent(value);
        }

        public int childCount => _children.Count;

        public Vector3 localPosition
        {
            get
            {
                RequireAlive("get_localPosition");
                return _localPosition;
            }
            set
            {
                RequireAlive("set_localPosition");
                _localPosition = value;
            }
        }

        public Quaternion localRotation
        {
            get
            {
                RequireAlive("get_localRotation");
                return _localRotation;
            }
            set
            {
                RequireAlive("set_localRotation");
                _localRotation = value;
            }
        }

        public Vector3 localScale
        {
            get
            {
                RequireAlive("get_localScale");
                return _localScale;
            }
            set
            {
                RequireAlive("set_localScale");
                _localScale = value;
            }
        }

        public Vector3 position
        {
            get => localToWorldMatrix.GetPosition();
            set => localPosition = _parent == null ? value : _parent.InverseTransformPoint(value);
        }

        public Quaternion rotation
        {
            get => _parent == null ? localRotation : _parent.rotation * localRotation;
            set => localRotation = _parent == null ? value : Quaternion.Inverse(_parent.rotation) * value;
        }

        public Vector3 lossyScale => localToWorldMatrix.lossyScale;

        public Vector3 forward => rotation * Vector3.forward;

        public Matrix4x4 localToWorldMatrix
        {
            get
            {
                RequireAlive("get_localToWorldMatrix");
                Matrix4x4 local = Matrix4x4.TRS(_localPosition, _localRotation, _localScale);
                return _parent == null ? local : _parent.localToWorldMatrix * local;
            }
        }

        public Matrix4x4 worldToLocalMatrix => localToWorldMatrix.inverse;

        public void SetParent(Transform p) => SetParent(p, true);

        public void SetParent(Transform parent, bool worldPositionStays)
        {
            RequireAlive("SetParent");
            if (parent == _parent)
                return;
            if (parent != null && parent.IsChildOf(this))
            {
                Debug.LogError("A transform can't become a child of itself or of its own children.");
                return;
            }

            Matrix4x4 world = localToWorldMatrix;
            Quaternion worldRotation = rotation;
            _parent?._children.Remove(this);
            _parent = parent;
            _parent?._children.Add(this);
            if (worldPositionStays)
            {
                position = world.GetPosition();
                rotation = worldRotation;
                Vector3 scale = world.lossyScale, outer = _parent == null ? Vector3.one : _parent.lossyScale;
                localScale = new Vector3(scale.x / outer.x, scale.y / outer.y, scale.z / outer.z);
            }

            Lifecycle.RefreshHierarchy(Owner);
        }

        public bool IsChildOf(Transform parent)
        {
            for (Transform at = this; at != null; at = at._parent)
                if (at == parent)
                    return true;
            return false;
        }

        public Transform GetChild(int index)
        {
            if ((uint)index >= (uint)_children.Count)
                throw new UnityException("Transform child out of bounds");
            return _children[index];
        }

        public void SetPositionAndRotation(Vector3 position, Quaternion rotation)
        {
            this.position = position;
            this.rotation = rotation;
        }

        public Vector3 TransformPoint(Vector3 position) => localToWorldMatrix.MultiplyPoint3x4(position);

        public Vector3 InverseTransformPoint(Vector3 position) => worldToLocalMatrix.MultiplyPoint3x4(position);

        public Vector3 TransformVector(Vector3 vector) => localToWorldMatrix.MultiplyVector(vector);

        public Vector3 TransformDirection(Vector3 direction) => rotation * direction;

        internal void Detach()
        {
            if (!(_parent is null))
                _parent._children.Remove(this);
            _parent = null;
        }

        internal override void CopyStateOf(Component original)
        {
            var other = (Transform)original;
            (_localPosition, _localRotation, _localScale) =
                (other._localPosition, other._localRotation, other._localScale);
        }

        internal override bool MayBeDestroyed()
        {
            Debug.LogError("Can't destroy Transform component of '" + name + "'. If you want to destroy the game " +
                "object, please call 'Destroy' on the game object instead.");
            return false;
        }
    }
}
