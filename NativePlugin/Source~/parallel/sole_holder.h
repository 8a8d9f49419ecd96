// SPDX-License-Identifier: MIT
// Objects that are used again once nobody else holds them, as pools keep them by shared_ptr.
#pragma once

#include <memory>
#include <vector>

namespace quickses {

// True if the pointer is the only one left, and whoever held another one has read its last. To look at the count would
// not order memory; to take part in it by lock() does, as an acquiring operation on what they counted down.
template <class T>
bool is_sole_holder(const std::shared_ptr<T> &pointer) {
  return std::weak_ptr<T>(pointer).lock().use_count() == 2;
}

// One that nobody else holds; null: there is none.
template <class T>
std::shared_ptr<T> find_unheld(const std::vector<std::shared_ptr<T>> &pool) {
  for (const std::shared_ptr<T> &one : pool)
    if (is_sole_holder(one)) return one;
  return nullptr;
}

}  // namespace quickses
