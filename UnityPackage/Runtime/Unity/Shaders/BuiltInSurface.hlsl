// SPDX-License-Identifier: MIT
// What all passes for the built-in pipeline share.
#ifndef QUICKSES_BUILT_IN_SURFACE
#define QUICKSES_BUILT_IN_SURFACE

#include "UnityCG.cginc"
#include "QuickSesAtomColor.hlsl"

Texture2D _QuickSesAtomColors;
float _QuickSesAtomColorsWidth;
half4 _Color;
half4 _BaseColor;
half _Smoothness;
half _Metallic;
half _OcclusionStrength;

struct Attributes
{
    float4 vertex : POSITION;
    float3 normal : NORMAL;
    fixed4 color : COLOR;
    float2 occlusion : TEXCOORD1;
    uint owner : TEXCOORD7;
    UNITY_VERTEX_INPUT_INSTANCE_ID
};

float4 SurfaceColor(Attributes v, out float isShown)
{
    return QuickSesVertexColor(_QuickSesAtomColors, _QuickSesAtomColorsWidth, v.owner, v.color, isShown);
}

// Of what is drawn; always 1 where the surface is opaque. What can't be seen hides nothing behind it either.
half SurfaceAlpha(float isShown, float colorAlpha)
{
    QuickSesDiscardHidden(isShown);
    #if defined(QUICKSES_TRANSPARENT)
    half alpha = colorAlpha * _Color.a * _BaseColor.a;
    clip(alpha - 1.5 / 255.0);
    return alpha;
    #else
    return 1;
    #endif
}

#endif
