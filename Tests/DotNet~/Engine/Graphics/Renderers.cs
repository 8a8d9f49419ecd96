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

        // The same mesh, which therefore is nobody's instance.
        internal override void CopyStateOf(Component original) => _mesh = ((MeshFilter)original)._mesh;
    }

    public class Renderer : Component
    {
        private readonly MaterialPropertyBlock _block = new MaterialPropertyBlock();
        private Material[] _materials = Array.Empty<Material>();

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

        // Property blocks are not copied along.
        internal override void CopyStateOf(Component original) =>
            _materials = (Material[])((Renderer)original)._materials.Clone();
    }

    public class MeshRenderer : Renderer
    {
    }
}
