// SPDX-License-Identifier: MIT
// Stands in for the file of this name: what the package's shaders use of it, with the same names and types.
#ifndef STAND_IN_SHADOWS
#define STAND_IN_SHADOWS
#include "Core.hlsl"

#if defined(_MAIN_LIGHT_SHADOWS) && !defined(_MAIN_LIGHT_SHADOWS_CASCADE)
#define REQUIRES_VERTEX_SHADOW_COORD_INTERPOLATOR
#endif

float3 ApplyShadowBias(float3 position, float3 normal, float3 light) { return position - 0.01 * (normal + light); }
float4 TransformWorldToShadowCoord(float3 position) { return float4(position, 1); }
float4 GetShadowCoord(VertexPositionInputs inputs) { return TransformWorldToShadowCoord(inputs.positionWS); }

#endif
