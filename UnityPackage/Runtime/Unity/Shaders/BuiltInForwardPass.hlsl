// SPDX-License-Identifier: MIT
// The first light with everything that is not a light of its own, or with QUICKSES_FURTHER_LIGHT one more light.
#include "BuiltInSurface.hlsl"
#include "UnityPBSLighting.cginc"
#include "AutoLight.cginc"

struct Varyings
{
    UNITY_POSITION(pos);
    float3 worldPos : TEXCOORD0;
    half3 worldNormal : TEXCOORD1;
    half4 color : TEXCOORD2;
    half3 ambient : TEXCOORD3;
    UNITY_FOG_COORDS(4)
    UNITY_LIGHTING_COORDS(5, 6)
    float2 shownAndOcclusion : TEXCOORD7;
    UNITY_VERTEX_INPUT_INSTANCE_ID
    UNITY_VERTEX_OUTPUT_STEREO
};

struct Material
{
    half3 diffuse;
    half3 specular;
    half oneMinusReflectivity;
    half3 normal;
    half3 viewDirection;
};

Varyings Vertex(Attributes v)
{
    UNITY_SETUP_INSTANCE_ID(v);
    Varyings o;
    UNITY_INITIALIZE_OUTPUT(Varyings, o);
    UNITY_TRANSFER_INSTANCE_ID(v, o);
    UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(o);

    o.pos = UnityObjectToClipPos(v.vertex);
    o.worldPos = mul(unity_ObjectToWorld, v.vertex).xyz;
    o.worldNormal = UnityObjectToWorldNormal(v.normal);
    o.color = SurfaceColor(v, o.shownAndOcclusion.x);
    o.shownAndOcclusion.y = QuickSesOcclusion(v.occlusion, _OcclusionStrength);

    #if !defined(QUICKSES_FURTHER_LIGHT)
    // The light of probes and of lights that are not lit by pixel.
    #if defined(VERTEXLIGHT_ON)
    o.ambient = Shade4PointLights(unity_4LightPosX0, unity_4LightPosY0, unity_4LightPosZ0,
        unity_LightColor[0].rgb, unity_LightColor[1].rgb, unity_LightColor[2].rgb, unity_LightColor[3].rgb,
        unity_4LightAtten0, o.worldPos, o.worldNormal);
    #endif
    o.ambient = ShadeSHPerVertex(o.worldNormal, o.ambient);
    #endif

    UNITY_TRANSFER_LIGHTING(o, float2(0, 0));
    UNITY_TRANSFER_FOG(o, o.pos);
    return o;
}

Material MaterialAt(Varyings i, fixed facing)
{
    Material material;
    half3 albedo = i.color.rgb * _Color.rgb * _BaseColor.rgb;
    material.diffuse = DiffuseAndSpecularFromMetallic(
        albedo, _Metallic, material.specular, material.oneMinusReflectivity);
    // An outward normal seen from inside, through a two-sided surface, must be turned round.
    material.normal = normalize(i.worldNormal) * (facing > 0 ? 1 : -1);
    material.viewDirection = normalize(UnityWorldSpaceViewDir(i.worldPos));
    return material;
}

half3 Shade(Material material, UnityLight light, UnityIndirect indirect)
{
    return UNITY_BRDF_PBS(material.diffuse, material.specular, material.oneMinusReflectivity, _Smoothness,
        material.normal, material.viewDirection, light, indirect).rgb;
}

#if defined(QUICKSES_FURTHER_LIGHT)
half4 Fragment(Varyings i, fixed facing : VFACE) : SV_Target
{
    UNITY_SETUP_INSTANCE_ID(i);
    UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(i);
    half alpha = SurfaceAlpha(i.shownAndOcclusion.x, i.color.a);
    UNITY_LIGHT_ATTENUATION(attenuation, i, i.worldPos);

    UnityLight light;
    UNITY_INITIALIZE_OUTPUT(UnityLight, light);
    light.color = _LightColor0.rgb * attenuation;
    light.dir = normalize(UnityWorldSpaceLightDir(i.worldPos));
    UnityIndirect none;
    UNITY_INITIALIZE_OUTPUT(UnityIndirect, none);

    half4 color = half4(Shade(MaterialAt(i, facing), light, none), alpha);
    UNITY_APPLY_FOG_COLOR(i.fogCoord, color, half4(0, 0, 0, 0));
    return color;
}
#else
half4 Fragment(Varyings i, fixed facing : VFACE) : SV_Target
{
    UNITY_SETUP_INSTANCE_ID(i);
    UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(i);
    half alpha = SurfaceAlpha(i.shownAndOcclusion.x, i.color.a);
    Material material = MaterialAt(i, facing);
    UNITY_LIGHT_ATTENUATION(attenuation, i, i.worldPos);

    UnityGIInput input;
    UNITY_INITIALIZE_OUTPUT(UnityGIInput, input);
    input.light.color = _LightColor0.rgb;
    input.light.dir = _WorldSpaceLightPos0.xyz;
    input.worldPos = i.worldPos;
    input.worldViewDir = material.viewDirection;
    input.atten = attenuation;
    input.ambient = i.ambient;
    input.probeHDR[0] = unity_SpecCube0_HDR;
    input.probeHDR[1] = unity_SpecCube1_HDR;
    #if defined(UNITY_SPECCUBE_BLENDING) || defined(UNITY_SPECCUBE_BOX_PROJECTION)
    input.boxMin[0] = unity_SpecCube0_BoxMin;
    #endif
    #if defined(UNITY_SPECCUBE_BOX_PROJECTION)
    input.boxMax[0] = unity_SpecCube0_BoxMax;
    input.probePosition[0] = unity_SpecCube0_ProbePosition;
    input.boxMax[1] = unity_SpecCube1_BoxMax;
    input.boxMin[1] = unity_SpecCube1_BoxMin;
    input.probePosition[1] = unity_SpecCube1_ProbePosition;
    #endif
    Unity_GlossyEnvironmentData reflection = UnityGlossyEnvironmentSetup(
        _Smoothness, material.viewDirection, material.normal, material.specular);
    UnityGI gi = UnityGlobalIllumination(input, i.shownAndOcclusion.y, material.normal, reflection);

    half4 color = half4(Shade(material, gi.light, gi.indirect), alpha);
    UNITY_APPLY_FOG(i.fogCoord, color);
    return color;
}
#endif
