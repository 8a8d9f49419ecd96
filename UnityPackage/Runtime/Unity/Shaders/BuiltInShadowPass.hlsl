// SPDX-License-Identifier: MIT
// What a light sees, and the camera's depth texture.
#include "BuiltInSurface.hlsl"

struct Varyings
{
    V2F_SHADOW_CASTER;
    float2 shownAndAlpha : TEXCOORD1;
    UNITY_VERTEX_INPUT_INSTANCE_ID
    UNITY_VERTEX_OUTPUT_STEREO
};

Varyings Vertex(Attributes v)
{
    Varyings o;
    UNITY_SETUP_INSTANCE_ID(v);
    UNITY_INITIALIZE_OUTPUT(Varyings, o);
    UNITY_TRANSFER_INSTANCE_ID(v, o);
    UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(o);
    o.shownAndAlpha.y = SurfaceColor(v, o.shownAndAlpha.x).a;
    TRANSFER_SHADOW_CASTER_NORMALOFFSET(o)
    return o;
}

half4 Fragment(Varyings i) : SV_Target
{
    UNITY_SETUP_INSTANCE_ID(i);
    SurfaceAlpha(i.shownAndAlpha.x, i.shownAndAlpha.y);
    SHADOW_CASTER_FRAGMENT(i)
}
