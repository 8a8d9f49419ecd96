// SPDX-License-Identifier: MIT
#include "cudart/kernel_graph.h"

#include "cudart/loaded_kernel.h"

namespace quickses {
namespace cudart {
namespace {

// An edge that lets a kernel be sent when the one before it lets it, or ends (CU_GRAPH_KERNEL_NODE_PORT_PROGRAMMATIC,
// CU_GRAPH_DEPENDENCY_TYPE_PROGRAMMATIC).
constexpr GraphEdge kSentAhead{1, 0, 1, {}};

CUresult describe(const KernelLaunch &launch, CUDA_KERNEL_NODE_PARAMS_v1 *node, bool *may_overlap) {
  LoadedKernel kernel;
  const CUresult result = find_kernel(launch.kernel, &kernel);
  *node = {};
  node->func = kernel.function;
  node->gridDimX = launch.blocks;
  node->blockDimX = launch.threads;
  node->gridDimY = node->gridDimZ = node->blockDimY = node->blockDimZ = 1;
  node->sharedMemBytes = static_cast<unsigned>(launch.shared_bytes);
  node->kernelParams = launch.arguments;
  *may_overlap = kernel.may_overlap();
  return result;
}

// A node for the kernel, behind those there are.
CUresult add(const Driver &d, CUgraph graph, const KernelLaunch &launch, std::vector<CUgraphNode> *nodes) {
  CUDA_KERNEL_NODE_PARAMS_v1 what;
  bool may_overlap = false;
  CUresult result = describe(launch, &what, &may_overlap);
  if (result != CUDA_SUCCESS) return result;
  const CUgraphNode *const before = nodes->empty() ? nullptr : &nodes->back();
  const bool ahead = before && may_overlap && d.cuGraphAddDependencies_v2;
  CUgraphNode node = nullptr;
  result = d.cuGraphAddKernelNode(&node, graph, ahead ? nullptr : before, before && !ahead ? 1 : 0, &what);
  if (result == CUDA_SUCCESS && ahead) result = d.cuGraphAddDependencies_v2(graph, before, &node, &kSentAhead, 1);
  if (result == CUDA_SUCCESS) nodes->push_back(node);
  return result;
}

}  // namespace

cudaError_t KernelGraph::make(const std::vector<KernelLaunch> &launches) {
  nodes_.clear();
  nodes_.reserve(launches.size());
  return inside([&](const Driver &d) {
    if (!d.has_graphs()) return CUDA_ERROR_NOT_SUPPORTED;
    CUresult result = d.cuGraphCreate(&graph_, 0);
    for (const KernelLaunch &launch : launches)
      if (result == CUDA_SUCCESS) result = add(d, graph_, launch, &nodes_);
    return result == CUDA_SUCCESS ? d.cuGraphInstantiateWithFlags(&made_, graph_, 0) : result;
  });
}

cudaError_t KernelGraph::change(size_t k, const KernelLaunch &launch) {
  return inside([&](const Driver &d) {
    CUDA_KERNEL_NODE_PARAMS_v1 what;
    bool may_overlap = false;
    const CUresult result = describe(launch, &what, &may_overlap);
    return result == CUDA_SUCCESS ? d.cuGraphExecKernelNodeSetParams(made_, nodes_[k], &what) : result;
  });
}

cudaError_t KernelGraph::launch(cudaStream_t stream) {
  return inside([&](const Driver &d) { return d.cuGraphLaunch(made_, stream); });
}

void KernelGraph::release() {
  if (made_) driver().cuGraphExecDestroy(made_);
  if (graph_) driver().cuGraphDestroy(graph_);
  made_ = nullptr;
  graph_ = nullptr;
  nodes_.clear();
}

}  // namespace cudart
}  // namespace quickses
