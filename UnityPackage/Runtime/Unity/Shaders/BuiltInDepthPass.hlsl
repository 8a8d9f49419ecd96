// SPDX-License-Identifier: MIT
// Depth alone, of the nearest layer.
#include "BuiltInSurface.hlsl"

struct Varyings
{
    float4 pos : SV_POSITION;
    float2 shownAndAlpha : TEXCOORD0;
    UNITY_VERTEX_INPUT_INSTANCE_ID
    UNITY_VERTEX_OUTPUT_STEREO
};

Varyings Vertex(Attributes v)
{
    UNITY_SETUP_INSTANCE_ID(v);
    Varyings o;
    UNITY_INITIALIZE_OUTPUT(Varyings, o);
    UNITY_TRANSFER_INSTANCE_ID(v, o);
    UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(o);
    o.pos = UnityObjectToClipPos(v.vertex);
    o.shownAndAlpha.y = SurfaceColor(v, o.shownAndAlpha.x).a;
    return o;
}

half4 Fragment(Varyings i) : SV_Target
{
    UNITY_SETUP_INSTANCE_ID(i);
    UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(i);
    SurfaceAlpha(i.shownAndAlpha.x, i.shownAndAlpha.y);
    return 0;
}
