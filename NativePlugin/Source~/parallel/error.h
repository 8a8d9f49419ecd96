// SPDX-License-Identifier: MIT
// The exceptions that travel inside the library; the C API turns them into status codes.
#pragma once

#include "quickses/quickses.h"

#include <new>
#include <stdexcept>
#include <string>

namespace quickses {

class Error : public std::runtime_error {
 public:
  Error(qses_status status, const std::string &message) : std::runtime_error(message), status_(status) {}
  qses_status status() const { return status_; }

 private:
  qses_status status_;
};

[[noreturn]] inline void invalid(const std::string &message) { throw Error(QSES_INVALID_ARGUMENT, message); }

// Memory that the budget or the machine refused. The engine then tries with less (surface/memory_ladder.h); else it is
// the caller's error. again: what was asked for is accounted for by now, and the same once more may do.
class MemoryRefused : public Error {
 public:
  explicit MemoryRefused(const std::string &message, bool again = false)
      : Error(QSES_OUT_OF_MEMORY, message), again_(again) {}
  bool again() const { return again_; }

 private:
  bool again_;
};

// A computation that was told to stop. Not an error: whoever asked for it knows.
struct Cancelled {};

// In a catch block: take(status, sentence) is told what the exception that is being handled comes to. Needs no memory;
// the sentence is there as long as the call.
template <class Take>
void explain_exception(const Take &take) {
  try {
    throw;
  } catch (const Error &e) {
    take(e.status(), e.what());
  } catch (const Cancelled &) {
    take(QSES_CANCELLED, "the computation was cancelled");
  } catch (const std::bad_alloc &) {
    take(QSES_OUT_OF_MEMORY, "the machine refused memory");
  } catch (const std::length_error &) {
    take(QSES_OUT_OF_MEMORY, "more was asked for than memory can hold");
  } catch (const std::exception &e) {
    take(QSES_INTERNAL_ERROR, e.what());
  } catch (...) {
    take(QSES_INTERNAL_ERROR, "an unknown exception");
  }
}

}  // namespace quickses
