// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    public sealed class Shader : Object
    {
        private static readonly Dictionary<string, int> s_ids = new Dictionary<string, int>();
        private static readonly Dictionary<string, Shader> s_shaders = new Dictionary<string, Shader>();

        internal Shader(string name, string[] properties)
        {
            this.name = name;
            foreach (string property in properties)
                Properties.Add(PropertyToID(property));
        }

        internal HashSet<int> Properties { get; } = new HashSet<int>();

        public bool isSupported => true;

        public int renderQueue => 2000;

        public static int PropertyToID(string name)
        {
            lock (s_ids)
            {
                if (!s_ids.TryGetValue(name, out int id))
                    s_ids[name] = id = s_ids.Count + 1;
                return id;
            }
        }

        /// <summary>What a test has registered, or null: as in a player that has stripped the shader.</summary>
        public static Shader Find(string name) =>
            s_shaders.TryGetValue(name, out Shader shader) && shader != null ? shader : null;

        internal static Shader Register(string name, string[] properties) =>
            s_shaders[name] = new Shader(name, properties);
    }

    public class Material : Object
    {
        private readonly Dictionary<int, object> _values = new Dictionary<int, object>();
        private readonly HashSet<string> _keywords = new HashSet<string>();
        private Shader _shader;

        public Material(Shader shader)
        {
            _shader = shader != null ? shader : throw new ArgumentNullException(nameof(shader));
            name = shader.name;
        }

        public Material(Material source)
        {
            _shader = source._shader;
            name = source.name;
            CopyPropertiesFromMaterial(source);
        }

        public Shader shader
        {
            get
            {
                RequireAlive("get_shader");
                return _shader;
            }
            set
            {
                RequireAlive("set_shader");
                _shader = value;
            }
        }

        public int renderQueue { get; set; } = 2000;

        public Color color
        {
            get => GetColor("_Color");
            set => SetColor("_Color", value);
        }

        public bool HasProperty(string name) => HasProperty(Shader.PropertyToID(name));

        public bool HasProperty(int nameID) => shader.Properties.Contains(nameID);

        public void SetFloat(string name, float value) => SetFloat(Shader.PropertyToID(name), value);
        public void SetFloat(int nameID, float value) => Set(nameID, value);
        public float GetFloat(string name) => GetFloat(Shader.PropertyToID(name));
        public float GetFloat(int nameID) => Get<float>(nameID);

        public void SetInt(string name, int value) => SetFloat(name, value);
        public void SetInt(int nameID, int value) => SetFloat(nameID, value);
        public int GetInt(string name) => (int)GetFloat(name);
        public int GetInt(int nameID) => (int)GetFloat(nameID);

        public void SetColor(string name, Color value) => SetColor(Shader.PropertyToID(name), value);
        public void SetColor(int nameID, Color value) => Set(nameID, value);
        public Color GetColor(string name) => GetColor(Shader.PropertyToID(name));
        public Color GetColor(int nameID) => Get<Color>(nameID);

        public void SetVector(string name, Vector4 value) => SetVector(Shader.PropertyToID(name), value);
        public void SetVector(int nameID, Vector4 value) => Set(nameID, value);
        public Vector4 GetVector(string name) => GetVector(Shader.PropertyToID(name));
        public Vector4 GetVector(int nameID) => Get<Vector4>(nameID);

        public void EnableKeyword(string keyword) => _keywords.Add(keyword);

        public void DisableKeyword(string keyword) => _keywords.Remove(keyword);

        public bool IsKeywordEnabled(string keyword) => _keywords.Contains(keyword);

        public void CopyPropertiesFromMaterial(Material mat)
        {
            foreach (KeyValuePair<int, object> value in mat._values)
                _values[value.Key] = value.Value;
            _keywords.UnionWith(mat._keywords);
        }

        private void Set(int id, object value)
        {
            RequireAlive("Material.Set");
            _values[id] = value;
        }

        private T Get<T>(int id)
        {
            RequireAlive("Material.Get");
            return _values.TryGetValue(id, out object value) && value is T typed ? typed : default;
        }
    }

    public sealed class MaterialPropertyBlock
    {
        private readonly Dictionary<int, object> _values = new Dictionary<int, object>();

        public bool isEmpty => _values.Count == 0;

        public void SetFloat(int nameID, float value) => _values[nameID] = value;

        public void SetColor(int nameID, Color value) => _values[nameID] = value;

        public void SetVector(int nameID, Vector4 value) => _values[nameID] = value;

        public float GetFloat(int nameID) =>
            _values.TryGetValue(nameID, out object value) && value is float number ? number : 0;

        public void Clear() => _values.Clear();

        internal void CopyFrom(MaterialPropertyBlock other)
        {
            _values.Clear();
            if (other != null)
                foreach (KeyValuePair<int, object> value in other._values)
                    _values[value.Key] = value.Value;
        }
    }
}
