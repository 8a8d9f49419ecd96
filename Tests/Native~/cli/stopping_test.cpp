// SPDX-License-Identifier: MIT
// How the program ends where memory runs out in the midst of something that may not throw.
#include "cli/stopping.h"

#include <new>

#include "cli/exit_code.h"
#include "io/atomic_file.h"
#include "io/io_fixture.h"

namespace quickses::cli {
namespace {

#if !defined(_WIN32)  // without fork() the program would begin anew, in a folder of its own

using StarvedProgram = io::IoTest;

[[noreturn]] void starve_while_writing(const std::string &path) {
  prepare_for_stopping();
  io::AtomicFile file(path);
  file.write("half of it");
  const auto fail = [] { throw std::bad_alloc(); };
  [&]() noexcept { fail(); }();
  std::_Exit(kOk);
}

TEST_F(StarvedProgram, EndsWithAMessageAndLeavesNothingBehind) {
  const std::string name = write("a.csv", "as it was");
  EXPECT_EXIT(starve_while_writing(name), testing::ExitedWithCode(kComputingFailed), kNotEnoughMemory);
  EXPECT_EQ(io::slurp(name), "as it was");
  EXPECT_EQ(file_count(), 1u);
}

#endif

}  // namespace
}  // namespace quickses::cli
