// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    public sealed class MeshFilter : Component
    {
        private Mesh _mesh;

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
            }
        }

        internal override void DropReferences(Predicate<Object> isDropped)
        {
            if (_mesh != null && isDropped(_mesh))
                _mesh = null;
        }

        // The same mesh, which therefore is nobody's instance.
        internal override void CopyStateOf(Component original) => _mesh = ((MeshFilter)original)._mesh;
    }

    public class Renderer : Component
    {
        private readonly MaterialPropertyBlock _block = new MaterialPropertyBlock();
        private Material[] _materials = Array.Empty<Material>();
        private Bounds _ownBounds;

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

        /// <summary>A copy.</summary>
        public Material[] sharedMaterials
        {
            get
            {
                RequireAlive("get_sharedMaterials");
                return (Material[])_materials.Clone();
            }
            set
            {
                RequireAlive("set_sharedMaterials");
                _materials = (Material[])value.Clone();
            }
        }

        public bool enabled { get; set; } = true;

        public bool receiveShadows { get; set; } = true;

        /// <summary>
        /// Those that were set; else those of the mesh of a filter beside it, if there is one.
        /// </summary>
        public Bounds localBounds
        {
            get
            {
                RequireAlive("get_localBounds");
                var filter = GetComponent<MeshFilter>();
                return HasOwnBounds ? _ownBounds : filter != null && filter.sharedMesh != null
                    ? filter.sharedMesh.bounds
                    : default;
            }
            set
            {
                RequireAlive("set_localBounds");
                _ownBounds = value;
                HasOwnBounds = true;
            }
        }

        /// <summary>Only the double tells.</summary>
        public bool HasOwnBounds { get; private set; }

        public void ResetLocalBounds()
        {
            RequireAlive("ResetLocalBounds");
            HasOwnBounds = false;
        }

        public bool HasPropertyBlock() => !_block.isEmpty;

        /// <summary>A copy; null: none.</summary>
        public void SetPropertyBlock(MaterialPropertyBlock properties)
        {
            RequireAlive("SetPropertyBlock");
            _block.CopyFrom(properties);
        }

        public void GetPropertyBlock(MaterialPropertyBlock properties)
        {
            RequireAlive("GetPropertyBlock");
            if (properties == null)
                throw new ArgumentNullException(nameof(properties));
            properties.CopyFrom(_block);
        }

        internal override void DropReferences(Predicate<Object> isDropped)
        {
            for (int k = 0; k < _materials.Length; ++k)
                if (_materials[k] != null && isDropped(_materials[k]))
                    _materials[k] = null;
        }

        // Property blocks are not copied along.
        internal override void CopyStateOf(Component original)
        {
            var other = (Renderer)original;
            _materials = (Material[])other._materials.Clone();
            (enabled, receiveShadows) = (other.enabled, other.receiveShadows);
        }
    }

    public class MeshRenderer : Renderer
    {
    }
}
