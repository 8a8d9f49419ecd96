// SPDX-License-Identifier: MIT
// Which back ends this machine offers, and why not.
#pragma once

#include "quickses/quickses.h"

namespace quickses {

// What backend (not AUTO) is like. device: CUDA ordinal.
qses_backend_description describe_backend(qses_backend backend, int device);

// Says that it is the CPU with so many threads.
void name_cpu(unsigned threads, qses_backend_description *description);

// CUDA devices; 0 without CUDA.
uint32_t count_devices();

}  // namespace quickses
