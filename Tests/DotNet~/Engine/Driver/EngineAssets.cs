// SPDX-License-Identifier: MIT
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>Assets that a project would have; they are there until <see cref="Engine.Reset"/>.</summary>
    public static class EngineAssets
    {
        public static TextAsset CreateTextAsset(string name, byte[] bytes) => new TextAsset(bytes) { name = name };

        /// <summary>A shader that Shader.Find finds, with the properties it has.</summary>
        public static Shader CreateShader(string name, params string[] properties) =>
            Shader.Register(name, properties);

        /// <summary>Lets Resources.Load find an asset.</summary>
        public static void AddResource(string path, Object asset) => Resources.Add(path, asset);

        public static void SetStreamingAssetsPath(string path) => Application.streamingAssetsPath = path;

        public static void SetColorSpace(ColorSpace colorSpace) => QualitySettings.activeColorSpace = colorSpace;
    }
}
