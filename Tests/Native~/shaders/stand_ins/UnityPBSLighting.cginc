// SPDX-License-Identifier: MIT
// Stands in for Unity's file of this name: what the package's shaders use of it, with the same names and types.
#ifndef STAND_IN_UNITY_PBS_LIGHTING
#define STAND_IN_UNITY_PBS_LIGHTING
#include "UnityCG.cginc"

struct UnityLight { half3 color; half3 dir; half ndotl; };
struct UnityIndirect { half3 diffuse; half3 specular; };
struct UnityGI { UnityLight light; UnityIndirect indirect; };
struct UnityGIInput
{
    UnityLight light;
    float3 worldPos;
    half3 worldViewDir;
    half atten;
    half3 ambient;
    float4 lightmapUV;
    float4 boxMin[2];
    float4 boxMax[2];
    float4 probePosition[2];
    float4 probeHDR[2];
};
struct Unity_GlossyEnvironmentData { half roughness; half3 reflUVW; };

float4 _LightColor0;

half3 DiffuseAndSpecularFromMetallic(half3 albedo, half metallic, out half3 specular, out half oneMinusReflectivity)
{
    specular = lerp(half3(0.04, 0.04, 0.04), albedo, metallic);
    oneMinusReflectivity = 0.96 * (1 - metallic);
    return albedo * oneMinusReflectivity;
}
Unity_GlossyEnvironmentData UnityGlossyEnvironmentSetup(half smoothness, half3 view, half3 normal, half3 specular)
{
    Unity_GlossyEnvironmentData data;
    data.roughness = 1 - smoothness;
    data.reflUVW = reflect(-view, normal) * specular;
    return data;
}
UnityGI UnityGlobalIllumination(UnityGIInput input, half occlusion, half3 normal, Unity_GlossyEnvironmentData reflection)
{
    UnityGI gi = (UnityGI)0;
    gi.light = input.light;
    gi.light.color *= input.atten;
    gi.indirect.diffuse = input.ambient * occlusion;
    return gi;
}
half4 StandInBrdf(half3 diffuse, half3 specular, half oneMinusReflectivity, half smoothness, half3 normal, half3 view,
    UnityLight light, UnityIndirect indirect)
{
    return half4(diffuse * (light.color * saturate(dot(normal, light.dir)) + indirect.diffuse), 1);
}
#define UNITY_BRDF_PBS StandInBrdf

#endif
