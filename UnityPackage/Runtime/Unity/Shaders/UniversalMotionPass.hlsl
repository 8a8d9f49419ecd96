// SPDX-License-Identifier: MIT
// How far each pixel has come since the frame before, with the object and the camera. That vertices of a new surface are elsewhere
// is no motion: they are not those of the one before.
#include "UniversalSurface.hlsl"
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/MotionVectorsCommon.hlsl"

struct Attributes
{
    float4 positionOS : POSITION;
    half4 color : COLOR;
    uint owner : TEXCOORD7;
    UNITY_VERTEX_INPUT_INSTANCE_ID
};

struct Varyings
{
    float4 positionCS : SV_POSITION;
    float4 present : TEXCOORD0;
    float4 previous : TEXCOORD1;
    float2 shownAndAlpha : TEXCOORD2;
    UNITY_VERTEX_INPUT_INSTANCE_ID
    UNITY_VERTEX_OUTPUT_STEREO
};

Varyings Vertex(Attributes input)
{
    Varyings output = (Varyings)0;
    UNITY_SETUP_INSTANCE_ID(input);
    UNITY_TRANSFER_INSTANCE_ID(input, output);
    UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output);
    output.positionCS = SurfacePositionCS(input.positionOS.xyz);
    // Without the camera's jitter, which is no motion either.
    output.present = mul(_NonJitteredViewProjMatrix, mul(UNITY_MATRIX_M, float4(input.positionOS.xyz, 1)));
    output.previous = mul(_PrevViewProjMatrix, mul(UNITY_PREV_MATRIX_M, float4(input.positionOS.xyz, 1)));
    output.shownAndAlpha.y = SurfaceColor(input.color, input.owner, output.shownAndAlpha.x).a;
    return output;
}

float4 Fragment(Varyings input) : SV_Target
{
    UNITY_SETUP_INSTANCE_ID(input);
    UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
    SurfaceAlpha(input.shownAndAlpha.x, input.shownAndAlpha.y);
    return float4(CalcNdcMotionVectorFromCsPositions(input.present, input.previous), 0, 0);
}
