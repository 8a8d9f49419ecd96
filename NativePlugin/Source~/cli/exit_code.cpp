// SPDX-License-Identifier: MIT
// What the program tells the shell.
#include "cli/exit_code.h"

#include <new>

#include "io/error.h"

namespace quickses::cli {
namespace {

ExitCode exit_code_of(io::ErrorKind kind) {
  switch (kind) {
    case io::ErrorKind::kUsage:
      return kUsage;
    case io::ErrorKind::kInput:
      return kInputUnreadable;
    case io::ErrorKind::kOutput:
      return kOutputUnwritable;
  }
  return kComputingFailed;
}

}  // namespace

Failure failure_of(std::exception_ptr exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const Failure &failure) {
    return failure;
  } catch (const io::Error &error) {
    return Failure(exit_code_of(error.kind()), error.what());
  } catch (const std::bad_alloc &) {
    return Failure(kComputingFailed, kNotEnoughMemory);
  } catch (const std::exception &error) {
    return Failure(kComputingFailed, std::string("unexpected error: ") + error.what());
  } catch (...) {
    return Failure(kComputingFailed, "unexpected error");
  }
}

}  // namespace quickses::cli
