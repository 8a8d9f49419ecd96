// SPDX-License-Identifier: MIT
// The colours of atoms, for the package's shaders and for those of others.
//
// A mesh has a colour per vertex (COLOR), or the atom that each vertex belongs to (TEXCOORD7, an unsigned integer); then the
// colours are in the texture _QuickSesAtomColors, one texel per atom, row by row, and _QuickSesAtomColorsWidth is its width.
// A width of 0 means: by vertex. Both are sRGB bytes. The texture says so of itself, and is converted where it is read; colours of
// vertices nobody converts on the way here. An atom whose alpha in the texture is 0 is hidden.
//
// In Shader Graph: a node Custom Function with this file, name QuickSesAtomColor; see "Other shaders" in Documentation~/unity.md.
#ifndef QUICKSES_ATOM_COLOR
#define QUICKSES_ATOM_COLOR

// Of sRGB, by its definition (IEC 61966-2-1). In projects whose colour space is gamma, shaders compute in sRGB.
float3 QuickSesToWorkingSpace(float3 srgb)
{
    #if defined(UNITY_COLORSPACE_GAMMA)
    return srgb;
    #else
    float3 low = srgb / 12.92;
    float3 high = pow(abs(srgb + 0.055) / 1.055, 2.4);
    return float3(
        srgb.r <= 0.04045 ? low.r : high.r, srgb.g <= 0.04045 ? low.g : high.g, srgb.b <= 0.04045 ? low.b : high.b);
    #endif
}

// The texture is read in the vertex stage, so that colours run into each other between atoms as those of vertices do.
// isShown: 0 for a hidden atom, else 1.
float4 QuickSesVertexColor(Texture2D colors, float width, uint owner, float4 vertexColor, out float isShown)
{
    isShown = 1;
    if (width <= 0)
        return float4(QuickSesToWorkingSpace(vertexColor.rgb), vertexColor.a);
    uint columns = uint(width);
    float4 color = colors.Load(int3(int(owner % columns), int(owner / columns), 0));
    isShown = color.a > 0 ? 1 : 0;
    return color;
}

// What ambient occlusion leaves of the light, from texture coordinate 1: x from 0 (closed in) to 1 (open), y anything but 0. Where
// there is none, 0, 0 is read, and nothing is taken.
float QuickSesOcclusion(float2 texcoord, float strength)
{
    return texcoord.x == 0 && texcoord.y == 0 ? 1.0 : lerp(1.0, saturate(texcoord.x), strength);
}

// A triangle goes if any of its atoms is hidden, as SetVisible does it otherwise: 1 within, less where a corner is hidden.
void QuickSesDiscardHidden(float isShown)
{
    clip(isShown - 0.99);
}

// For Shader Graph, which reads no integers of vertices: Color is that of the node Vertex Color.
void QuickSesAtomColor_float(float4 Color, out float3 Rgb, out float Alpha)
{
    Rgb = QuickSesToWorkingSpace(Color.rgb);
    Alpha = Color.a;
}

void QuickSesAtomColor_half(half4 Color, out half3 Rgb, out half Alpha)
{
    Rgb = half3(QuickSesToWorkingSpace(Color.rgb));
    Alpha = Color.a;
}

#endif
