// SPDX-License-Identifier: MIT
// What libFuzzer calls. QUICKSES_FUZZ_TARGET: the target of this program.
#include "fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz::QUICKSES_FUZZ_TARGET(data, size);
  return 0;
}
