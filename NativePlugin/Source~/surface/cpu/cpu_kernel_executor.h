// SPDX-License-Identifier: MIT
// The CPU's executor together with the kernels that its hot stages run.
#pragma once

#include "parallel/cpu_executor.h"
#include "surface/cpu/cpu_kernels.h"

namespace quickses {

class CpuKernelExecutor : public CpuExecutor {
 public:
  explicit CpuKernelExecutor(const WorkerThreads &threads, const CpuKernels &kernels = cpu_kernels())
      : CpuExecutor(threads), kernels_(&kernels) {}

  const CpuKernels &kernels() const { return *kernels_; }

 private:
  const CpuKernels *kernels_;
};

}  // namespace quickses
