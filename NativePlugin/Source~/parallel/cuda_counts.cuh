// SPDX-License-Identifier: MIT
// What passes count in a frame on a CUDA device: where they count, the same in host memory once it is sent there, and
// what is anticipated of it.
#pragma once

#include "parallel/anticipation.h"
#include "parallel/cuda_memory.h"
#include "parallel/cuda_passes.cuh"

#include <algorithm>
#include <cstring>

namespace quickses {

class CudaCounts {
 public:
  // Of the device: counts, and zeros behind them.
  static constexpr size_t kBytes = 16384, kZeroBytes = 384 * 1024, kDeviceBytes = kBytes + kZeroBytes;

  CudaCounts() = default;
  // With the device selected, before anything else.
  void allocate() {
    on_host_.reserve(kBytes);
    on_device_ = static_cast<unsigned char *>(memory_.reserve(kDeviceBytes));
    check_cuda(cudaEventCreateWithFlags(&sent_, cudaEventDisableTiming), "cudaEventCreateWithFlags");
  }
  // The same when nothing counts any more.
  void release() {
    if (sent_) cudaEventDestroy(sent_);
    memory_.release();
  }
  CudaCounts(const CudaCounts &) = delete;
  CudaCounts &operator=(const CudaCounts &) = delete;

  // A frame begins (Anticipation::open). Returns what is to be filled with zeros for it; note_zeros() when it will be.
  Span<unsigned char> open(uint64_t kind) {
    is_sent_ = false;
    anticipation_.open(kind);
    if (!anticipation_.is_open()) return {};
    used_ = zeros_used_ = 0;
    return written();
  }
  // What is no longer zero.
  Span<unsigned char> written() const { return {on_device_, written_}; }
  void note_zeros() { written_ = 0; }
  // That may not have been done.
  void doubt_zeros() { written_ = kDeviceBytes; }
  // Its memory for zeros, or nullptr if there is too little left.
  void *take_zeros(size_t bytes) {
    bytes = padded(bytes);
    if (!anticipation_.is_open() || bytes > kZeroBytes - zeros_used_) return nullptr;
    zeros_used_ += bytes;
    written_ = std::max(written_, kBytes + zeros_used_);
    return on_device_ + kBytes + zeros_used_ - bytes;
  }
  template <class T>
  T *take() {
    if (!anticipation_.is_open() || used_ + Anticipation::kMostBytes > kBytes) return nullptr;
    used_ += padded(sizeof(T));
    written_ = std::max(written_, used_);
    return reinterpret_cast<T *>(on_device_ + used_ - padded(sizeof(T)));
  }
  // Whether they were taken here.
  bool has(const void *counts) const {
    const auto *const bytes = static_cast<const unsigned char *>(counts);
    return anticipation_.is_open() && bytes >= on_device_ && bytes < on_device_ + kBytes;
  }
  Anticipation &anticipation() { return anticipation_; }
  const Anticipation &anticipation() const { return anticipation_; }
  size_t place_of(const void *counts) const {
    return static_cast<size_t>(static_cast<const unsigned char *>(counts) - on_device_);
  }

  // What is anticipated so far is being counted. Returns what brings it to the host, for each of so many words.
  gpu::CopyWords begin_to_send(size_t *words) {
    anticipation_.note_counting();
    *words = used_ / sizeof(uint32_t);
    return {static_cast<uint32_t *>(on_host_.data()), reinterpret_cast<const uint32_t *>(on_device_)};
  }
  void note_sent(cudaStream_t stream) {
    is_sent_ = true;
    check_cuda(cudaEventRecord(sent_, stream), "cudaEventRecord");
  }
  // Waits for it, and compares. False: nothing was sent. Throws AnticipatedTooLittle.
  bool verify() {
    if (!is_sent_) return false;
    is_sent_ = false;
    check_cuda(cudaEventSynchronize(sent_), "cudaEventSynchronize");
    anticipation_.verify(static_cast<const unsigned char *>(on_host_.data()));
    return true;
  }
  // As they were sent.
  template <class T>
  T verified(const T *counts) const {
    T value;
    std::memcpy(&value, static_cast<const unsigned char *>(on_host_.data()) + place_of(counts), sizeof value);
    return value;
  }

 private:
  static constexpr size_t padded(size_t bytes) { return (bytes + 15) / 16 * 16; }

  Anticipation anticipation_;
  GrowingBuffer<DeviceMemory> memory_;
  unsigned char *on_device_ = nullptr;  // there
  size_t used_ = 0, zeros_used_ = 0;    // by this frame
  size_t written_ = kDeviceBytes;       // so much may not be zero any more
  PinnedBuffer on_host_;
  cudaEvent_t sent_ = nullptr;
  bool is_sent_ = false;
};

}  // namespace quickses
