// SPDX-License-Identifier: MIT
// Stands in for Unity's file of this name: what the package's shaders use of it, with the same names and types.
#ifndef STAND_IN_UNITY_CG
#define STAND_IN_UNITY_CG

#define fixed float
#define fixed4 float4

#define UNITY_POSITION(pos) float4 pos : SV_POSITION
#define UNITY_INITIALIZE_OUTPUT(type, name) name = (type)0
#if defined(INSTANCING_ON)
#define UNITY_VERTEX_INPUT_INSTANCE_ID uint instanceID : SV_InstanceID;
#define UNITY_TRANSFER_INSTANCE_ID(from, to) to.instanceID = from.instanceID
#else
#define UNITY_VERTEX_INPUT_INSTANCE_ID
#define UNITY_TRANSFER_INSTANCE_ID(from, to)
#endif
static uint unity_InstanceID;
#if defined(INSTANCING_ON)
#define UNITY_SETUP_INSTANCE_ID(input) unity_InstanceID = input.instanceID
#else
#define UNITY_SETUP_INSTANCE_ID(input)
#endif
#if defined(STEREO_INSTANCING_ON)
#define UNITY_VERTEX_OUTPUT_STEREO uint eye : SV_RenderTargetArrayIndex;
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output) output.eye = unity_InstanceID & 1
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input) unity_InstanceID = input.eye
#else
#define UNITY_VERTEX_OUTPUT_STEREO
#define UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output)
#define UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input)
#endif

cbuffer Engine
{
    float4x4 unity_ObjectToWorld;
    float4x4 unity_MatrixVP;
    float4 _WorldSpaceCameraPos;
    float4 _WorldSpaceLightPos0;
    float4 unity_FogColor;
    float4 unity_FogParams;
    float4 unity_4LightPosX0, unity_4LightPosY0, unity_4LightPosZ0, unity_4LightAtten0;
    float4 unity_LightColor[8];
    float4 unity_SpecCube0_HDR, unity_SpecCube1_HDR;
    float4 unity_SpecCube0_BoxMin, unity_SpecCube0_BoxMax, unity_SpecCube0_ProbePosition;
    float4 unity_SpecCube1_BoxMin, unity_SpecCube1_BoxMax, unity_SpecCube1_ProbePosition;
};

float4 UnityObjectToClipPos(float4 position) { return mul(unity_MatrixVP, mul(unity_ObjectToWorld, position)); }
float3 UnityObjectToWorldNormal(float3 normal) { return normalize(mul((float3x3)unity_ObjectToWorld, normal)); }
float3 UnityWorldSpaceViewDir(float3 position) { return _WorldSpaceCameraPos.xyz - position; }
float3 UnityWorldSpaceLightDir(float3 position) { return _WorldSpaceLightPos0.xyz - position * _WorldSpaceLightPos0.w; }
float3 Shade4PointLights(float4 x, float4 y, float4 z, float3 a, float3 b, float3 c, float3 d, float4 attenuation, float3 position,
    float3 normal) { return a + b + c + d + (x + y + z + attenuation).xyz * position * normal; }
float3 ShadeSHPerVertex(float3 normal, float3 ambient) { return ambient + 0.2 * (normal.y + 1.0); }

#if defined(FOG_LINEAR) || defined(FOG_EXP) || defined(FOG_EXP2)
#define UNITY_FOG_COORDS(index) float fogCoord : TEXCOORD##index;
#define UNITY_TRANSFER_FOG(output, position) output.fogCoord = position.z
#define UNITY_APPLY_FOG_COLOR(coordinate, color, fog) color.rgb = lerp((fog).rgb, color.rgb, saturate(coordinate))
#else
#define UNITY_FOG_COORDS(index)
#define UNITY_TRANSFER_FOG(output, position)
#define UNITY_APPLY_FOG_COLOR(coordinate, color, fog)
#endif
#define UNITY_APPLY_FOG(coordinate, color) UNITY_APPLY_FOG_COLOR(coordinate, color, unity_FogColor)

#if defined(SHADOWS_CUBE)
#define V2F_SHADOW_CASTER UNITY_POSITION(pos); float3 vec : TEXCOORD0
#define TRANSFER_SHADOW_CASTER_NORMALOFFSET(o) o.vec = mul(unity_ObjectToWorld, v.vertex).xyz; o.pos = UnityObjectToClipPos(v.vertex);
#define SHADOW_CASTER_FRAGMENT(i) return length(i.vec);
#else
#define V2F_SHADOW_CASTER UNITY_POSITION(pos)
#define TRANSFER_SHADOW_CASTER_NORMALOFFSET(o) o.pos = UnityObjectToClipPos(float4(v.vertex.xyz - 0.01 * v.normal, 1));
#define SHADOW_CASTER_FRAGMENT(i) return 0;
#endif

#endif
