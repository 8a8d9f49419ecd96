// SPDX-License-Identifier: MIT
// Depth alone; with QUICKSES_WITH_NORMALS also normals, which screen-space ambient occlusion reads.
#include "UniversalSurface.hlsl"
#if defined(QUICKSES_WITH_NORMALS)
#include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Packing.hlsl"
#endif

struct Attributes
{
    float4 positionOS : POSITION;
    float3 normalOS : NORMAL;
    half4 color : COLOR;
    uint owner : TEXCOORD7;
    UNITY_VERTEX_INPUT_INSTANCE_ID
};

struct Varyings
{
    float4 positionCS : SV_POSITION;
    half3 normalWS : TEXCOORD0;
    float2 shownAndAlpha : TEXCOORD1;
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
    output.normalWS = half3(TransformObjectToWorldNormal(input.normalOS));
    output.shownAndAlpha.y = SurfaceColor(input.color, input.owner, output.shownAndAlpha.x).a;
    return output;
}

half4 Fragment(Varyings input, FRONT_FACE_TYPE face : FRONT_FACE_SEMANTIC) : SV_Target
{
    UNITY_SETUP_INSTANCE_ID(input);
    UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
    SurfaceAlpha(input.shownAndAlpha.x, input.shownAndAlpha.y);
    #if defined(QUICKSES_WITH_NORMALS)
    half3 normalWS = FacingNormal(input.normalWS, face);
    #if defined(_GBUFFER_NORMALS_OCT)
    float2 octahedral = saturate(PackNormalOctQuadEncode(normalWS) * 0.5 + 0.5);
    return half4(PackFloat2To888(octahedral), 0);
    #else
    return half4(normalWS, 0);
    #endif
    #else
    return input.positionCS.z;
    #endif
}
