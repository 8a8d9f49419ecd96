// SPDX-License-Identifier: MIT
#include "process/touched_pages.h"

#include "process/host_memory.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>

namespace quickses {
namespace {

TEST(TouchedPages, CanBeWrittenToTheLastByte) {
  for (const size_t bytes :
       {size_t(1), size_t(4096), size_t(70000), size_t(4) << 20, (size_t(4) << 20) + 1, size_t(37) * 1000 * 1000}) {
    char *const memory = static_cast<char *>(TouchedPages::acquire(bytes));
    if (!memory) GTEST_SKIP() << "this machine has less than " << 4 * bytes << " bytes to give";
    EXPECT_EQ(reinterpret_cast<uintptr_t>(memory) % 4096, 0u) << "pages that others use, too, would be locked";
    EXPECT_EQ(memory[0], 0);
    EXPECT_EQ(memory[(bytes - 1) / 4096 * 4096], 0) << "the last page was not touched";
    std::memset(memory, 7, bytes);
    EXPECT_EQ(memory[bytes - 1], 7);
    TouchedPages::release(memory);
  }
}

TEST(TouchedPages, AreRefusedWhereMemoryMightNotSuffice) {
  const uint64_t free = HostMemory::free_bytes();
  EXPECT_EQ(TouchedPages::acquire(static_cast<size_t>(free / 2)), nullptr);
  EXPECT_EQ(TouchedPages::acquire(std::numeric_limits<size_t>::max() / 2), nullptr);
}

}  // namespace
}  // namespace quickses
