// SPDX-License-Identifier: MIT
// Stands in for Unity's file of this name: what the package's shaders use of it, with the same names.
#if defined(SHADOWS_SCREEN) || defined(SHADOWS_DEPTH) || defined(SHADOWS_CUBE)
#define UNITY_LIGHTING_COORDS(light, shadow) float4 _LightCoord : TEXCOORD##light; float4 _ShadowCoord : TEXCOORD##shadow;
#define UNITY_TRANSFER_LIGHTING(output, uv) output._LightCoord = output.pos; output._ShadowCoord = output.pos
#define UNITY_LIGHT_ATTENUATION(name, input, position) half name = saturate(input._ShadowCoord.w + input._LightCoord.x)
#else
#define UNITY_LIGHTING_COORDS(light, shadow)
#define UNITY_TRANSFER_LIGHTING(output, uv)
#define UNITY_LIGHT_ATTENUATION(name, input, position) half name = 1
#endif
