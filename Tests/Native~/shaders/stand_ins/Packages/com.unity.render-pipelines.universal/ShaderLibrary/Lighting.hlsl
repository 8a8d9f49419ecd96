// SPDX-License-Identifier: MIT
// Stands in for the file of this name: what the package's shaders use of it, with the same names and types.
#ifndef STAND_IN_LIGHTING
#define STAND_IN_LIGHTING
#include "Shadows.hlsl"

struct SurfaceData
{
    half3 albedo;
    half3 specular;
    half metallic;
    half smoothness;
    half3 normalTS;
    half3 emission;
    half occlusion;
    half alpha;
    half clearCoatMask;
    half clearCoatSmoothness;
};
struct InputData
{
    float3 positionWS;
    half3 normalWS;
    half3 viewDirectionWS;
    float4 shadowCoord;
    half fogCoord;
    half3 vertexLighting;
    half3 bakedGI;
    float2 normalizedScreenSpaceUV;
    half4 shadowMask;
};

half3 VertexLighting(float3 position, half3 normal)
{
    #if defined(_ADDITIONAL_LIGHTS_VERTEX)
    return 0.1 * saturate(normal);
    #else
    return half3(0, 0, 0);
    #endif
}
half3 SampleSH(half3 normal) { return 0.2 * (normal.y + 1.0); }
half4 UniversalFragmentPBR(InputData lighting, SurfaceData surface)
{
    half light = saturate(dot(lighting.normalWS, normalize(half3(-0.4, 0.7, -0.6))));
    return half4(surface.albedo * (light + surface.occlusion * lighting.bakedGI + lighting.vertexLighting), surface.alpha);
}

#endif
