// SPDX-License-Identifier: MIT
// Objects that are used again once nobody else holds them, as pools keep them by shared_ptr.
#pragma once

#include <memory>

namespace quickses {

// True if the pointer is the only one left, and whoever held another one has read its last. To look at the count would
// not order memory; to take part in it by lock() does, as an acquiring operation on what they counted down.
template <class T>
bool is_sole_holder(const std::shared_ptr<T> &pointer) {
  return std::weak_ptr<T>(pointer).lock().use_count() == 2;
}

}  // namespace quickses
