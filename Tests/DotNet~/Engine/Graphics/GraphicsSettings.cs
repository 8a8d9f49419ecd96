// SPDX-License-Identifier: MIT

namespace UnityEngine.Rendering
{
    public abstract class RenderPipelineAsset : ScriptableObject
    {
        public virtual Material defaultMaterial => null;
    }

    /// <summary>The double has the built-in pipeline, which has no asset.</summary>
    public sealed class GraphicsSettings : Object
    {
        public static RenderPipelineAsset currentRenderPipeline => null;
    }
}
