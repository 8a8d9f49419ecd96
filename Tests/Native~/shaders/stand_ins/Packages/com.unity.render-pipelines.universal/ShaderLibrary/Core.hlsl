// SPDX-License-Identifier: MIT
// Stands in for the file of this name: what the package's shaders use of it, with the same names and types.
#ifndef STAND_IN_CORE
#define STAND_IN_CORE

#define CBUFFER_START(name) cbuffer name {
#define CBUFFER_END };
#define FRONT_FACE_TYPE bool
#define FRONT_FACE_SEMANTIC SV_IsFrontFace
#define IS_FRONT_VFACE(face, front, back) ((face) ? (front) : (back))
#define UNITY_REVERSED_Z 1
#define UNITY_NEAR_CLIP_VALUE 1.0

static uint unity_InstanceID;
#if defined(INSTANCING_ON)
#define UNITY_VERTEX_INPUT_INSTANCE_ID uint instanceID : SV_InstanceID;
#define UNITY_TRANSFER_INSTANCE_ID(from, to) to.instanceID = from.instanceID
#define UNITY_SETUP_INSTANCE_ID(input) unity_InstanceID = input.instanceID
#else
#define UNITY_VERTEX_INPUT_INSTANCE_ID
#define UNITY_TRANSFER_INSTANCE_ID(from, to)
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
    float4x4 unity_MatrixPreviousM;
    float4x4 unity_MatrixVP;
    float4x4 _NonJitteredViewProjMatrix;
    float4x4 _PrevViewProjMatrix;
    float4 unity_MotionVectorsParams;
    float4 _WorldSpaceCameraPos;
    float4 unity_FogColor;
};

#define UNITY_MATRIX_M unity_ObjectToWorld
#define UNITY_PREV_MATRIX_M unity_MatrixPreviousM

struct VertexPositionInputs { float3 positionWS; float3 positionVS; float4 positionCS; float4 positionNDC; };

float3 TransformObjectToWorld(float3 position) { return mul(unity_ObjectToWorld, float4(position, 1)).xyz; }
float4 TransformWorldToHClip(float3 position) { return mul(unity_MatrixVP, float4(position, 1)); }
float3 TransformObjectToWorldNormal(float3 normal) { return normalize(mul((float3x3)unity_ObjectToWorld, normal)); }
VertexPositionInputs GetVertexPositionInputs(float3 position)
{
    VertexPositionInputs inputs = (VertexPositionInputs)0;
    inputs.positionWS = TransformObjectToWorld(position);
    inputs.positionCS = TransformWorldToHClip(inputs.positionWS);
    return inputs;
}
float3 GetWorldSpaceNormalizeViewDir(float3 position) { return normalize(_WorldSpaceCameraPos.xyz - position); }
float ComputeFogFactor(float z) { return z; }
half3 MixFog(half3 color, half fog)
{
    #if defined(FOG_LINEAR) || defined(FOG_EXP) || defined(FOG_EXP2)
    return lerp(unity_FogColor.rgb, color, saturate(fog));
    #else
    return color;
    #endif
}
float2 GetNormalizedScreenSpaceUV(float4 position) { return position.xy; }

#endif
