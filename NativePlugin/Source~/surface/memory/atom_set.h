// SPDX-License-Identifier: MIT
// The atoms of a frame as the host gives them to a back end, and their memory.
#pragma once

#include "parallel/growing_buffer.h"
#include "parallel/sole_holder.h"
#include "surface/geometry/types.h"

#include <memory>
#include <mutex>
#include <vector>

namespace quickses {

// How large atoms are, without the probe. Where a few are much larger than all others, they are told apart, so that
// neighbours of the others need not be looked for as far away (ItemRadii).
struct AtomRadii {
  float largest = 0;
  float usual = 0;  // the largest, but for `large` atoms
  uint32_t large = 0;
};

// Everything about the atoms that the host knows before the back end sees them.
struct AtomBounds {
  glm::vec3 low, high;  // of the centres, caller's coordinates
  AtomRadii radii;
};

// The atoms of one frame in memory that the back end reads fast: centres in the caller's coordinates and van der Waals
// radii. Filled once, then only read.
struct AtomSet {
  Sphere *atoms = nullptr;
  size_t count = 0;
  AtomBounds bounds{};

  AtomSet() = default;
  AtomSet(const AtomSet &) = delete;
  AtomSet &operator=(const AtomSet &) = delete;
  virtual ~AtomSet() = default;
};

// Sets of atoms that are used again when nobody holds them any more. Source: of their memory, as of Arena.
template <class Source>
class AtomPool {
 public:
  std::shared_ptr<AtomSet> make(size_t count) {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::shared_ptr<Set> set = find_unheld(sets_);
    if (!set) {
      set = std::make_shared<Set>();
      sets_.push_back(set);
    }
    set->resize(count);
    return set;
  }
  uint64_t bytes() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    uint64_t sum = 0;
    for (const std::shared_ptr<Set> &set : sets_) sum += set->memory.size();
    return sum;
  }

 private:
  struct Set : AtomSet {
    GrowingBuffer<Source> memory;
    void resize(size_t n) {
      count = 0;
      atoms = static_cast<Sphere *>(memory.reserve(n * sizeof(Sphere)));
      count = n;
    }
  };

  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<Set>> sets_;
};

}  // namespace quickses
