// SPDX-License-Identifier: MIT
// What an event does to mapped buffers: copies of a mesh on the device, in a look of its own.
#pragma once

#include "kept/device_mesh.h"
#include "parallel/cuda_memory.h"
#include "surface/stages/appearance.h"

#include <memory>

namespace quickses {

// A look on the device: brought there when it is another one than before. Used by one thread.
class DeviceLook {
 public:
  explicit DeviceLook(int device) : device_(device) {}
  // Valid on the stream, which is always the same, until the next call. Null: nothing is set. Throws Error.
  AppearanceView use(const std::shared_ptr<const Appearance> &look, void *stream);

 private:
  const int device_;
  std::shared_ptr<const Appearance> there_;
  AppearanceView view_{};
  // Two in turn: the last look may still be on its way.
  struct Staging {
    PinnedBuffer memory;
    std::unique_ptr<StreamMark> copied;
  };
  Staging stagings_[2];
  int turn_ = 0;
  GrowingBuffer<DeviceMemory> memory_;
};

// Addresses on the device. Null: not wanted.
struct MappedBuffers {
  void *vertices;
  uint32_t *colors, *owners;
  float *texcoords;
  uint32_t *indices;
  size_t index_count;  // to be written: those behind the mesh's become 0
};

// On the stream; nobody waits. Throws Error.
void copy_mesh(const DeviceMesh &mesh, const AppearanceView &look, const MappedBuffers &to, void *stream);

}  // namespace quickses
