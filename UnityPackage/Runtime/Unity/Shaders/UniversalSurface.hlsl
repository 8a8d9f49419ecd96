// SPDX-License-Identifier: MIT
// What all passes for the Universal Render Pipeline share.
#ifndef QUICKSES_UNIVERSAL_SURFACE
#define QUICKSES_UNIVERSAL_SURFACE

#if defined(QUICKSES_TRANSPARENT)
// What the pipeline's own transparent materials define: shadows and occlusion on the screen are those of what is behind.
#define _SURFACE_TYPE_TRANSPARENT 1
#endif

#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"
#include "QuickSesAtomColor.hlsl"

Texture2D _QuickSesAtomColors;

// The same block in every pass, or the SRP Batcher refuses the shader.
CBUFFER_START(UnityPerMaterial)
    half4 _Color;
    half4 _BaseColor;
    half _Smoothness;
    half _Metallic;
    half _OcclusionStrength;
    float _QuickSesAtomColorsWidth;
CBUFFER_END

float4 SurfaceColor(half4 vertexColor, uint owner, out float isShown)
{
    return QuickSesVertexColor(_QuickSesAtomColors, _QuickSesAtomColorsWidth, owner, vertexColor, isShown);
}

// Of what is drawn; always 1 where the surface is opaque. What can't be seen hides nothing behind it either.
half SurfaceAlpha(float isShown, float colorAlpha)
{
    QuickSesDiscardHidden(isShown);
    #if defined(QUICKSES_TRANSPARENT)
    half alpha = half(colorAlpha) * _Color.a * _BaseColor.a;
    clip(alpha - 1.5 / 255.0);
    return alpha;
    #else
    return 1;
    #endif
}

// By the same steps in every pass, since depths of one pass are compared with those of another.
float4 SurfacePositionCS(float3 positionOS)
{
    return TransformWorldToHClip(TransformObjectToWorld(positionOS));
}

// An outward normal seen from inside, through a two-sided surface, must be turned round.
half3 FacingNormal(half3 normalWS, FRONT_FACE_TYPE face)
{
    return normalize(normalWS) * half(IS_FRONT_VFACE(face, 1.0, -1.0));
}

#endif
