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
  const char *name;  // for who tells of errors
  const void *kernel;
  unsigned blocks, threads;
  size_t shared_bytes;
  void **arguments;  // a pointer to each
};

// Use from one thread at a time, with its device selected. make(), change() and launch() leave errors to
// cudaGetLastError, as the functions of the runtime do. Nothing is given back but by release(): after a fault of the
// GPU the driver must not be handed what it lost.
class KernelGraph {
 public:
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
