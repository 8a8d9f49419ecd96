// SPDX-License-Identifier: MIT
// Kernels that are gathered on the host, and handed to the GPU together, as one CUDA graph: to launch each takes the
// host, and all threads together that use the GPU, two to three microseconds. For sequences of kernels that come again
// and again, if with other arguments.
#pragma once

#include "cudart/kernel_graph.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

namespace quickses {

// Use from one thread at a time, with the device selected.
class GatheredLaunches {
 public:
  using Launch = cudart::KernelLaunch;

  bool empty() const { return gathered_.launches.empty(); }
  bool is_full() const { return gathered_.launches.size() == kMost; }
  // The arguments are copied.
  template <class... Arguments>
  void add(const Launch &kernel, const Arguments &...arguments) {
    static_assert((std::is_trivially_copyable_v<Arguments> && ...), "as the driver copies them");
    gathered_.add(kernel, {{&arguments, sizeof(Arguments)}...});
  }
  // What is gathered is given up. False: nothing was.
  bool drop() {
    const bool was_there = !empty();
    gathered_.clear();
    return was_there;
  }

  // Hands it over, behind all that the stream has. launch_alone(launch): for those that are few, or that were not
  // gathered before in this order, or where there is no graph; it may throw.
  template <class LaunchAlone>
  void hand_over(cudaStream_t stream, const LaunchAlone &launch_alone) {
    const struct Drop {
      ~Drop() { launches.drop(); }
      GatheredLaunches &launches;
    } at_the_end{*this};
    if (gathered_.launches.size() >= kFewest && launch_known(stream)) return;
    gathered_.point();
    for (const Launch &launch : gathered_.launches) launch_alone(launch);
  }
  // How often something was handed over as a graph.
  uint64_t graphs() const { return graphs_; }
  // Gives the graphs back, which the destructor does not.
  void release() {
    for (Known &known : known_) known.graph.release();
    known_.clear();
  }

 private:
  static constexpr size_t kFewest = 4, kMost = 64, kMostKnown = 24;

  struct Argument {
    const void *value;
    size_t bytes;
  };
  // Launches with their arguments.
  struct Sequence {
    std::vector<Launch> launches;
    std::vector<size_t> first_bytes;      // of each launch's arguments
    std::vector<size_t> first_arguments;  // of each launch
    std::vector<size_t> places;           // of all arguments, in bytes
    std::vector<void *> pointers;         // to them
    std::vector<unsigned char> bytes;

    void add(const Launch &kernel, std::initializer_list<Argument> arguments) {
      first_bytes.push_back(bytes.size());
      first_arguments.push_back(places.size());
      for (const Argument &argument : arguments) {
        constexpr size_t kAlignment = 16;
        const size_t place = (bytes.size() + kAlignment - 1) / kAlignment * kAlignment;
        bytes.resize(place + argument.bytes);
        std::memcpy(bytes.data() + place, argument.value, argument.bytes);
        places.push_back(place);
      }
      launches.push_back(kernel);  // last: where memory is refused, it is not there
    }
    void clear() {
      launches.clear();
      first_bytes.clear();
      first_arguments.clear();
      places.clear();
      bytes.clear();
    }
    // Sets the launches' pointers to their arguments.
    void point() {
      pointers.resize(places.size());
      for (size_t k = 0; k < places.size(); ++k) pointers[k] = bytes.data() + places[k];
      for (size_t k = 0; k < launches.size(); ++k) launches[k].arguments = pointers.data() + first_arguments[k];
    }
    bool has_kernels_of(const Sequence &other) const {
      return launches.size() == other.launches.size() &&
             std::equal(launches.begin(), launches.end(), other.launches.begin(), [](const Launch &a, const Launch &b) {
               return a.kernel == b.kernel && a.threads == b.threads && a.shared_bytes == b.shared_bytes;
             });
    }
    // Whether a launch is the same in another sequence of these kernels.
    bool has_launch_of(const Sequence &other, size_t k) const {
      const size_t first = first_bytes[k], last = k + 1 < launches.size() ? first_bytes[k + 1] : bytes.size();
      return launches[k].blocks == other.launches[k].blocks &&
             std::memcmp(bytes.data() + first, other.bytes.data() + first, last - first) == 0;
    }
  };
  // A sequence that was gathered before.
  struct Known {
    Sequence last;  // as the graph has it
    cudart::KernelGraph graph;
    bool has_none = false;  // it can't be made
    uint64_t used = 0;
  };

  // nullptr: these kernels were not gathered before in this order; next time they will have been.
  Known *find() {
    ++uses_;
    for (Known &known : known_)
      if (known.last.has_kernels_of(gathered_)) {
        known.used = uses_;
        return &known;
      }
    if (known_.size() == kMostKnown) {
      const auto oldest = std::min_element(known_.begin(), known_.end(),
                                           [](const Known &a, const Known &b) { return a.used < b.used; });
      oldest->graph.release();
      known_.erase(oldest);
    }
    known_.emplace_back();
    known_.back().last = gathered_;
    known_.back().used = uses_;
    return nullptr;
  }
  // Launches what is gathered as a graph. False: there is none.
  bool launch_known(cudaStream_t stream) {
    Known *const known = find();
    if (!known || known->has_none) return false;
    gathered_.point();
    cudaError_t error = cudaSuccess;
    if (!known->graph.is_made())
      error = known->graph.make(gathered_.launches);
    else
      for (size_t k = 0; k < gathered_.launches.size() && error == cudaSuccess; ++k)
        if (!gathered_.has_launch_of(known->last, k)) error = known->graph.change(k, gathered_.launches[k]);
    if (error == cudaSuccess) error = known->graph.launch(stream);
    known->has_none = error != cudaSuccess;  // its launches alone say what is wrong, if something is
    if (known->has_none) {
      cudaGetLastError();
      return false;
    }
    std::swap(known->last, gathered_);
    ++graphs_;
    return true;
  }

  Sequence gathered_;
  std::vector<Known> known_;
  uint64_t uses_ = 0, graphs_ = 0;
};

}  // namespace quickses
