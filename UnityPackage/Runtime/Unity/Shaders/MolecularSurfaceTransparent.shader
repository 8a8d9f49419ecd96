// SPDX-License-Identifier: MIT
// A molecular surface that can be seen through: the alpha of the tint and that of the atoms are multiplied. Depth is drawn first,
// so that only the nearest layer of a surface shows, not its far side through it.
// First SubShader: Universal Render Pipeline 12 (Unity 2021.3) and later. Second: built-in pipeline.
// For the High Definition Render Pipeline see "Other shaders" in Documentation~/unity.md.
Shader "QuickSES/Molecular Surface Transparent"
{
    Properties
    {
        [MainColor] _Color("Tint", Color) = (1, 1, 1, 0.5)
        _Smoothness("Smoothness", Range(0, 1)) = 0.45
        _Metallic("Metallic", Range(0, 1)) = 0
        // A mesh without the attribute reads 0, 0, which stands for open.
        _OcclusionStrength("Ambient Occlusion (mesh TexCoord1.x, 1 = open)", Range(0, 1)) = 1
        [Enum(UnityEngine.Rendering.CullMode)] _Cull("Cull (Off = two-sided)", Float) = 2
        // The tint under the name that scripts written for the Universal Render Pipeline use; both are multiplied.
        [HideInInspector] _BaseColor("Tint", Color) = (1, 1, 1, 1)
        // Of each renderer, by the component: QuickSesAtomColor.hlsl.
        [HideInInspector] [NoScaleOffset] _QuickSesAtomColors("Colors of Atoms", 2D) = "white" {}
        [HideInInspector] _QuickSesAtomColorsWidth("Width of Colors of Atoms", Float) = 0
    }

    SubShader
    {
        PackageRequirements
        {
            "com.unity.render-pipelines.universal"
        }

        Tags
        {
            "RenderPipeline" = "UniversalPipeline"
            "RenderType" = "Transparent"
            "Queue" = "Transparent"
            "UniversalMaterialType" = "Lit"
        }

        Cull [_Cull]

        Pass
        {
            // Drawn before the pass below, whose fragments behind this depth are not drawn. A little behind itself, since the
            // two may round differently.
            Name "DepthOfNearestLayer"
            Tags { "LightMode" = "SRPDefaultUnlit" }

            ZWrite On
            ColorMask 0
            Offset 0, 2

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_instancing

            #define QUICKSES_TRANSPARENT
            #include "UniversalDepthPass.hlsl"
            ENDHLSL
        }

        Pass
        {
            // "ForwardOnly" is drawn by the Forward, Forward+ and Deferred renderers alike.
            Name "ForwardLit"
            Tags { "LightMode" = "UniversalForwardOnly" }

            Blend SrcAlpha OneMinusSrcAlpha, One OneMinusSrcAlpha
            ZWrite Off

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile _ _MAIN_LIGHT_SHADOWS _MAIN_LIGHT_SHADOWS_CASCADE
            #pragma multi_compile _ _ADDITIONAL_LIGHTS_VERTEX _ADDITIONAL_LIGHTS
            // Clustered lights: URP 14 to 17.0 say _FORWARD_PLUS, later ones _CLUSTER_LIGHT_LOOP.
            #pragma multi_compile _ _FORWARD_PLUS _CLUSTER_LIGHT_LOOP
            #pragma multi_compile_fragment _ _ADDITIONAL_LIGHT_SHADOWS
            // From URP 17.1 on, probes that are blended are in an atlas, and unity_SpecCube0 is none of them.
            #pragma multi_compile_fragment _ _REFLECTION_PROBE_BLENDING
            #pragma multi_compile_fragment _ _REFLECTION_PROBE_ATLAS
            #pragma multi_compile_fragment _ _SHADOWS_SOFT
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            #define QUICKSES_TRANSPARENT
            #include "UniversalForwardPass.hlsl"
            ENDHLSL
        }

        Pass
        {
            Name "ShadowCaster"
            Tags { "LightMode" = "ShadowCaster" }

            ZWrite On
            ZTest LEqual
            ColorMask 0

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_vertex _ _CASTING_PUNCTUAL_LIGHT_SHADOW
            #pragma multi_compile_instancing

            #define QUICKSES_TRANSPARENT
            #include "UniversalShadowPass.hlsl"
            ENDHLSL
        }
    }

    SubShader
    {
        Tags
        {
            "RenderType" = "Transparent"
            "Queue" = "Transparent"
        }

        Cull [_Cull]

        Pass
        {
            // As above.
            Name "DepthOfNearestLayer"
            Tags { "LightMode" = "Always" }

            ZWrite On
            ColorMask 0
            Offset 0, 2

            CGPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_instancing

            #define QUICKSES_TRANSPARENT
            #include "BuiltInDepthPass.hlsl"
            ENDCG
        }

        Pass
        {
            Name "ForwardBase"
            Tags { "LightMode" = "ForwardBase" }

            Blend SrcAlpha OneMinusSrcAlpha, One OneMinusSrcAlpha
            ZWrite Off

            CGPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_fwdbase nolightmap nodynlightmap nodirlightmap
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            #define QUICKSES_TRANSPARENT
            #include "BuiltInForwardPass.hlsl"
            ENDCG
        }

        Pass
        {
            // One pass for each further light that is lit by pixel.
            Name "ForwardAdd"
            Tags { "LightMode" = "ForwardAdd" }

            Blend SrcAlpha One, Zero One
            ZWrite Off

            CGPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_fwdadd_fullshadows
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            #define QUICKSES_TRANSPARENT
            #define QUICKSES_FURTHER_LIGHT
            #include "BuiltInForwardPass.hlsl"
            ENDCG
        }

        Pass
        {
            Name "ShadowCaster"
            Tags { "LightMode" = "ShadowCaster" }

            ZWrite On
            ZTest LEqual

            CGPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_shadowcaster
            #pragma multi_compile_instancing

            #define QUICKSES_TRANSPARENT
            #include "BuiltInShadowPass.hlsl"
            ENDCG
        }
    }
}
