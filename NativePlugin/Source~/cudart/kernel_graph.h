// SPDX-License-Identifier: MIT
// Kernels that follow each other, asked for all at once: a CUDA graph (CUDA Driver API, "Graph Management").
#pragma once

#include <cuda.h>
#include <cuda_runtime_api.h>

#include <cstddef>
#include <vector>

namespace quickses {
namespace cudart {

struct KernelLaunch {
  const void *kernel;
  unsigned blocks, threads;
  size_t shared_bytes;
  void **arguments;  // a pointer to each
};

// Use from one thread at a time, with its device selected. Functions that fail leave the error to cudaGetLastError, as
// those of the runtime.
class KernelGraph {
 public:
  KernelGraph() = default;
  KernelGraph(KernelGraph &&) noexcept;
  KernelGraph &operator=(KernelGraph &&) noexcept;
  ~KernelGraph() { release(); }

  // Of kernels that run one after the other; each is sent ahead of its turn, as by cudaLaunchKernelExC, where the
  // driver and the GPU can do that in a graph. cudaErrorNotSupported where there are no graphs.
  cudaError_t make(const std::vector<KernelLaunch> &launches);
  bool is_made() const { return made_ != nullptr; }
  // The k-th of them, from the next launch on: other arguments, or another number of blocks.
  cudaError_t change(size_t k, const KernelLaunch &launch);
  cudaError_t launch(cudaStream_t stream);
  void release();

 private:
  CUgraph graph_ = nullptr;
  CUgraphExec made_ = nullptr;
  std::vector<CUgraphNode> nodes_;
};

}  // namespace cudart
}  // namespace quickses
