// SPDX-License-Identifier: MIT
// What the parts of the stand-in for NVIDIA's driver share.
#pragma once

#include "cudart/driver.h"

#include <cstddef>
#include <cstdint>

#if !defined(FAKE_DEVICES)
#define FAKE_DEVICES 1
#endif

#if defined(_WIN32)
#define FAKE_API extern "C" __declspec(dllexport)
#else
#define FAKE_API extern "C" __attribute__((visibility("default")))
#endif

namespace fake_driver {

// What any function returns: the failure from one call on, for all the calls after it or for that one.
CUresult next(bool *fails = nullptr);

// Handles of devices are other numbers than their ordinals: nobody may take one for the other.
constexpr CUdevice kFirstDevice = 100;
inline CUdevice device_of(int ordinal) { return kFirstDevice + ordinal; }

inline void *host(CUdeviceptr p) { return reinterpret_cast<void *>(static_cast<uintptr_t>(p)); }
inline CUdeviceptr address(const void *p) { return reinterpret_cast<uintptr_t>(p); }

// Whether it is memory of a buffer that is mapped for the stream (fake_graphics.cpp).
bool is_mapped_for(CUdeviceptr memory, size_t bytes, CUstream stream);

// A line of the log that fake_graphics_log returns, if the calling thread is the one that draws.
void note_launch();

}  // namespace fake_driver
