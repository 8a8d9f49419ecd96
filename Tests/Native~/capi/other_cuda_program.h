// SPDX-License-Identifier: MIT
// Another user of CUDA in the same process, with a copy of NVIDIA's runtime of its own: as another plug-in has. It
// holds the primary context of device 0, memory and a stream. Any thread, one at a time. No CUDA in this header.
#pragma once

extern "C" {

// false: CUDA refuses.
__attribute__((visibility("default"))) bool other_start();

// Works on its memory by some kernels, and looks whether it holds what it should, and whether the selected device is
// still its own. "" if all is well, else what is wrong. Static storage.
__attribute__((visibility("default"))) const char *other_work();

// cudaDeviceReset: all that anybody has on the device is gone.
__attribute__((visibility("default"))) bool other_reset();

__attribute__((visibility("default"))) void other_end();

}  // extern "C"
