// SPDX-License-Identifier: MIT
using System;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public sealed class MeshFilter : Component
    {
        private Mesh _mesh;
        private bool _isInstance;

        public Mesh sharedMesh
        {
            get
            {
                RequireAlive("get_sharedMesh");
                return _mesh;
            }
            set
            {
                RequireAlive("set_sharedMesh");
                _mesh = value;
                _isInstance = false;
            }
        }

        /// <summary>Makes a mesh if there is none; with the filter it is not destroyed, as in the engine.</summary>
        public Mesh mesh
        {
            get
            {
                RequireAlive("get_mesh");
                if (_mesh == null)
                    _mesh = new Mesh { name = gameObject.name + " Instance" };
                else if (!_isInstance && !Application.isPlaying)
                    Debug.LogError("Instantiating mesh due to calling MeshFilter.mesh during edit mode. This will " +
                        "leak meshes. Please use MeshFilter.sharedMesh instead.");
                _isInstance = true;
                return _mesh;
            }
            set => sharedMesh = value;
        }

        // The same mesh, which therefore is nobody's instance.
        internal override void CopyStateOf(Component original) => _mesh = ((MeshFilter)original)._mesh;
    }

    public class Renderer : Component
    {
        private Material[] _materials = Array.Empty<Material>();
        private bool _enabled = true;

        public bool enabled
        {
            get
            {
                RequireAlive("get_enabled");
                return _enabled;
            }
            set
            {
                RequireAlive("set_enabled");
                _enabled = value;
            }
        }

        public Material sharedMaterial
        {
            get
            {
                RequireAlive("get_sharedMaterial");
                return _materials.Length > 0 ? _materials[0] : null;
            }
            set
            {
                RequireAlive("set_sharedMaterial");
                if (_materials.Length == 0)
                    _materials = new Material[1];
                _materials[0] = value;
            }
        }

        public Material[] sharedMaterials
        {
            get => (Material[])_materials.Clone();
            set => _materials = (Material[])value.Clone();
        }

        /// <summary>Makes a copy of the shared material, which its user has to destroy.</summary>
        public Material material
        {
            get
            {
                if (sharedMaterial != null && !sharedMaterial.name.EndsWith(" (Instance)", StringComparison.Ordinal))
                    sharedMaterial = new Material(sharedMaterial) { name = sharedMaterial.name + " (Instance)" };
                return sharedMaterial;
            }
            set => sharedMaterial = value;
        }

        public ShadowCastingMode shadowCastingMode { get; set; } = ShadowCastingMode.On;

        public bool receiveShadows { get; set; } = true;

        public bool isVisible => enabled && gameObject.activeInHierarchy;

        /// <summary>In world space; of the mesh as of the last time that its users were notified.</summary>
        public virtual Bounds bounds
        {
            get
            {
                Bounds local = localBounds;
                Matrix4x4 matrix = transform.localToWorldMatrix;
                Vector3 center = matrix.MultiplyPoint3x4(local.center), extents = Vector3.zero;
                for (int axis = 0; axis < 3; ++axis)
                {
                    Vector3 side = (Vector3)matrix.GetColumn(axis) * local.extents[axis];
                    extents += new Vector3(Mathf.Abs(side.x), Mathf.Abs(side.y), Mathf.Abs(side.z));
                }

                return new Bounds(center, extents * 2);
            }
        }

        public virtual Bounds localBounds => default;

        public void SetPropertyBlock(MaterialPropertyBlock properties) => Properties = properties;

        public void GetPropertyBlock(MaterialPropertyBlock properties) => properties.CopyFrom(Properties);

        internal MaterialPropertyBlock Properties { get; private set; }

        // Property blocks are not serialised.
        internal override void CopyStateOf(Component original)
        {
            var other = (Renderer)original;
            _enabled = other._enabled;
            _materials = (Material[])other._materials.Clone();
            shadowCastingMode = other.shadowCastingMode;
            receiveShadows = other.receiveShadows;
        }
    }

    public class MeshRenderer : Renderer
    {
        public override Bounds localBounds
        {
            get
            {
                RequireAlive("get_localBounds");
                return TryGetComponent(out MeshFilter filter) && filter.sharedMesh != null
                    ? filter.sharedMesh.Record.NotifiedBounds
                    : default;
            }
        }
    }
}
