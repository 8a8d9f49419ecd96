// SPDX-License-Identifier: MIT
// Found before the CUDA Toolkit's file of this name where Clang compiles CUDA for MinGW-w64. The toolkit takes every
// Windows for Visual C++'s and defines for the host what MinGW's math.h has already. On the device Clang has functions
// of its own; its wrapper (__clang_cuda_runtime_wrapper.h) only wants these to be declared.
#ifndef __MATH_FUNCTIONS_HPP__
#define __MATH_FUNCTIONS_HPP__
extern "C" {
float rsqrtf(float);
float rcbrtf(float);
float sinpif(float);
float cospif(float);
void sincospif(float, float *, float *);
float erfcinvf(float);
float normcdfinvf(float);
float normcdff(float);
float erfcxf(float);
}
#endif
