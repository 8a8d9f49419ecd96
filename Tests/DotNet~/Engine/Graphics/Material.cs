// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System.Collections.Generic;

namespace UnityEngine
{
    public class Shader : Object
    {
        private static readonly Dictionary<string, int> s_numbers = new Dictionary<string, int>();

        public static int PropertyToID(string name)
        {
            lock (s_numbers)
            {
                if (!s_numbers.TryGetValue(name, out int number))
                    s_numbers.Add(name, number = s_numbers.Count + 1);
                return number;
            }
        }
    }

    public class Material : Object
    {
        private readonly HashSet<int> _properties = new HashSet<int>();

        public Material()
        {
        }

        public Material(Material source)
        {
            name = source.name;
            hideFlags = source.hideFlags;
            shader = source.shader;
            CopyPropertiesFromMaterial(source);
        }

        public Shader shader { get; set; }

        public Color color { get; set; } = Color.white;

        /// <summary>Not the shader.</summary>
        public void CopyPropertiesFromMaterial(Material mat)
        {
            RequireAlive("CopyPropertiesFromMaterial");
            color = mat.color;
            _properties.UnionWith(mat._properties);
        }

        /// <summary>What the shader of the material has; only in the double.</summary>
        public Material DeclareProperty(string name)
        {
            _properties.Add(Shader.PropertyToID(name));
            return this;
        }

        public bool HasProperty(int nameID)
        {
            RequireAlive("HasProperty");
            return _properties.Contains(nameID);
        }

        public bool HasProperty(string name) => HasProperty(Shader.PropertyToID(name));
    }

    public sealed class MaterialPropertyBlock
    {
        private readonly Dictionary<int, float> _floats = new Dictionary<int, float>();
        private readonly Dictionary<int, Texture> _textures = new Dictionary<int, Texture>();

        public MaterialPropertyBlock() => EngineThread.Require("MaterialPropertyBlock");

        public bool isEmpty => _floats.Count == 0 && _textures.Count == 0;

        public void Clear()
        {
            _floats.Clear();
            _textures.Clear();
        }

        public void SetFloat(int nameID, float value) => _floats[nameID] = value;

        public void SetFloat(string name, float value) => SetFloat(Shader.PropertyToID(name), value);

        public void SetTexture(int nameID, Texture value)
        {
            if (value is null)
                throw new System.ArgumentNullException(nameof(value));
            _textures[nameID] = value;
        }

        public void SetTexture(string name, Texture value) => SetTexture(Shader.PropertyToID(name), value);

        public float GetFloat(int nameID) => _floats.TryGetValue(nameID, out float value) ? value : 0;

        public float GetFloat(string name) => GetFloat(Shader.PropertyToID(name));

        public Texture GetTexture(int nameID) =>
            _textures.TryGetValue(nameID, out Texture value) && value != null ? value : null;

        public Texture GetTexture(string name) => GetTexture(Shader.PropertyToID(name));

        internal void CopyFrom(MaterialPropertyBlock other)
        {
            Clear();
            if (other == null)
                return;
            foreach (KeyValuePair<int, float> entry in other._floats)
                _floats.Add(entry.Key, entry.Value);
            foreach (KeyValuePair<int, Texture> entry in other._textures)
                _textures.Add(entry.Key, entry.Value);
        }
    }
}
