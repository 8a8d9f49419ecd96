// SPDX-License-Identifier: MIT
// Work of a CUDA executor beside the rest: its kernels fill multiprocessors that wait for the last items of others, and
// go first.
#pragma once

#include "parallel/cuda_executor.cuh"

namespace quickses {

// What is queued here reads only what is known to be done (verify_counts()), or was queued here before. It takes
// nothing from the arena, where memory that was given up may still be in use by the other stream; what it got of it is
// not given up while this lives. At the end the executor's stream goes on behind all of it.
class SecondStream {
 public:
  explicit SecondStream(CudaExecutor &executor) : executor_(executor) { executor.open_second_stream(); }
  ~SecondStream() { executor_.join_second_stream(); }
  SecondStream(const SecondStream &) = delete;
  SecondStream &operator=(const SecondStream &) = delete;

  // What is queued from now on may read whatever the executor's stream has by now, and use memory that it gave up.
  void follow() { executor_.lead_second_stream(); }
  // Whatever give() asks of the executor.
  template <class Give>
  void queue(Give give) {
    executor_.hand_over();
    const Turn turn(executor_);
    give();
    executor_.hand_over();
  }

 private:
  struct Turn {
    explicit Turn(CudaExecutor &own) : executor(own) { executor.turn_to_second_stream(true); }
    ~Turn() { executor.turn_to_second_stream(false); }
    CudaExecutor &executor;
  };
  CudaExecutor &executor_;
};

}  // namespace quickses
