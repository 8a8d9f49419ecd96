// SPDX-License-Identifier: MIT
// Stands in for the file of this name: what the package's shaders use of it, with the same names and types.
#ifndef STAND_IN_MOTION_VECTORS
#define STAND_IN_MOTION_VECTORS

// In sizes of the picture; y upwards, as where pictures begin at the bottom.
float2 CalcNdcMotionVectorFromCsPositions(float4 present, float4 previous)
{
    return unity_MotionVectorsParams.y == 0 ? float2(0, 0) : 0.5 * (present.xy / present.w - previous.xy / previous.w);
}

#endif
