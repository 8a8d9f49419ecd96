// SPDX-License-Identifier: MIT
// What CUDA knows of the buffers of one target. Used by the thread that draws alone, with the graphics API's context
// current there.
#pragma once

#include "quickses/quickses_gpu.h"

#include <array>
#include <cstddef>
#include <cstdint>

struct cudaGraphicsResource;

namespace quickses {

// Whether this library and the driver can write into buffers of a graphics API. Throws Error with the reason why not.
void require_graphics(qses_graphics graphics);

class RegisteredBuffers {
 public:
  static constexpr size_t kMost = 5;
  enum Which { kVertices, kColors, kOwners, kTexcoords, kIndices };

  RegisteredBuffers() = default;
  RegisteredBuffers(const RegisteredBuffers &) = delete;
  RegisteredBuffers &operator=(const RegisteredBuffers &) = delete;

  // Makes buffers known to CUDA, unless they are those that are. The device is selected; before another one is, they
  // are to be forgotten. Throws Error: then none is known.
  void use(const qses_gpu_buffers &buffers, int device);
  // None is known any more. Must be done before the thread's context goes; what fails is the driver's to clean up.
  void forget() noexcept;

  // Of the buffers that are written.
  size_t count() const { return count_; }
  cudaGraphicsResource *const *resources() const { return resources_.data(); }
  // Address of a mapped buffer; nullptr: there is none. Throws Error if it has less than so many bytes.
  void *address(Which which, size_t bytes) const;
  // How many were made known so far.
  uint32_t registrations() const { return registrations_; }

 private:
  qses_gpu_buffers known_{};
  std::array<cudaGraphicsResource *, kMost> resources_{};  // count_ of them
  std::array<int, kMost> place_{};                         // in these, by Which; -1: none
  size_t count_ = 0;
  uint32_t registrations_ = 0;
};

}  // namespace quickses
