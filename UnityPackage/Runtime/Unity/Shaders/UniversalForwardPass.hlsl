// SPDX-License-Identifier: MIT
// All lights at once.
#include "UniversalSurface.hlsl"
#include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"

struct Attributes
{
    float4 positionOS : POSITION;
    float3 normalOS : NORMAL;
    half4 color : COLOR;
    float2 occlusion : TEXCOORD1;
    uint owner : TEXCOORD7;
    UNITY_VERTEX_INPUT_INSTANCE_ID
};

struct Varyings
{
    float4 positionCS : SV_POSITION;
    float3 positionWS : TEXCOORD0;
    half3 normalWS : TEXCOORD1;
    half4 color : TEXCOORD2;
    half4 fogAndVertexLight : TEXCOORD3;
    #if defined(REQUIRES_VERTEX_SHADOW_COORD_INTERPOLATOR)
    float4 shadowCoord : TEXCOORD4;
    #endif
    float2 shownAndOcclusion : TEXCOORD5;
    UNITY_VERTEX_INPUT_INSTANCE_ID
    UNITY_VERTEX_OUTPUT_STEREO
};

Varyings Vertex(Attributes input)
{
    Varyings output = (Varyings)0;
    UNITY_SETUP_INSTANCE_ID(input);
    UNITY_TRANSFER_INSTANCE_ID(input, output);
    UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output);

    VertexPositionInputs position = GetVertexPositionInputs(input.positionOS.xyz);
    output.positionCS = SurfacePositionCS(input.positionOS.xyz);
    output.positionWS = position.positionWS;
    output.normalWS = half3(TransformObjectToWorldNormal(input.normalOS));
    output.color = half4(SurfaceColor(input.color, input.owner, output.shownAndOcclusion.x));
    output.shownAndOcclusion.y = QuickSesOcclusion(input.occlusion, _OcclusionStrength);

    half fog = half(ComputeFogFactor(position.positionCS.z));
    output.fogAndVertexLight = half4(fog, VertexLighting(position.positionWS, output.normalWS));
    #if defined(REQUIRES_VERTEX_SHADOW_COORD_INTERPOLATOR)
    output.shadowCoord = GetShadowCoord(position);
    #endif
    return output;
}

half4 Fragment(Varyings input, FRONT_FACE_TYPE face : FRONT_FACE_SEMANTIC) : SV_Target
{
    UNITY_SETUP_INSTANCE_ID(input);
    UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);

    SurfaceData surface = (SurfaceData)0;
    surface.albedo = input.color.rgb * _Color.rgb * _BaseColor.rgb;
    surface.metallic = _Metallic;
    surface.smoothness = _Smoothness;
    surface.normalTS = half3(0, 0, 1);
    surface.occlusion = half(input.shownAndOcclusion.y);
    surface.alpha = SurfaceAlpha(input.shownAndOcclusion.x, input.color.a);

    InputData lighting = (InputData)0;
    lighting.positionWS = input.positionWS;
    lighting.normalWS = FacingNormal(input.normalWS, face);
    lighting.viewDirectionWS = half3(GetWorldSpaceNormalizeViewDir(input.positionWS));
    #if defined(REQUIRES_VERTEX_SHADOW_COORD_INTERPOLATOR)
    lighting.shadowCoord = input.shadowCoord;
    #else
    lighting.shadowCoord = TransformWorldToShadowCoord(input.positionWS);
    #endif
    lighting.vertexLighting = input.fogAndVertexLight.yzw;
    lighting.bakedGI = SampleSH(lighting.normalWS);
    lighting.normalizedScreenSpaceUV = GetNormalizedScreenSpaceUV(input.positionCS);
    lighting.shadowMask = half4(1, 1, 1, 1);

    half4 color = UniversalFragmentPBR(lighting, surface);
    color.rgb = MixFog(color.rgb, input.fogAndVertexLight.x);
    return half4(color.rgb, surface.alpha);
}
