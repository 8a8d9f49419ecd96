// SPDX-License-Identifier: MIT
// Stands in for the file of this name, with the same names and types.
float2 PackNormalOctQuadEncode(float3 n) { return n.xy / (abs(n.x) + abs(n.y) + abs(n.z)); }
float3 PackFloat2To888(float2 f) { return float3(f, 0); }
