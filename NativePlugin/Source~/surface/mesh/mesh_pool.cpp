// SPDX-License-Identifier: MIT
#include "surface/mesh/mesh_pool.h"

#include <algorithm>
#include <cstring>

namespace quickses {
namespace {

// Spares that are held back: levels of a ladder take one of each size. Their bytes are bounded too.
constexpr size_t kMostSpares = 12;
// A small mesh must not carry a large buffer away: how many times too large one may be, and what is small anyway.
constexpr size_t kMostTooLarge = 8, kSmall = size_t(1) << 20;
// A spare that so many meshes did not take won't be: they have become smaller, or fewer are in use at a time.
constexpr uint64_t kMostPassedBy = 32;

}  // namespace

MeshPool::MeshPool(Source source) : source_(std::move(source)) { spares_.reserve(kMostSpares + 1); }

std::unique_ptr<MeshBuffer> MeshPool::take(size_t bytes) {
  std::unique_ptr<MeshBuffer> buffer = take_spare(bytes);
  if (buffer) return buffer;
  buffer = std::make_unique<MeshBuffer>();
  if (bytes == 0) return buffer;
  // If the head room is refused then without; then at the cost of spares.
  buffer->size = size_for(bytes);
  while (!(buffer->memory = source_.acquire(buffer->size))) {
    const std::unique_ptr<MeshBuffer> spare = buffer->size == bytes ? oldest_spare() : nullptr;
    if (spare)
      release(*spare, source_.release);
    else if (buffer->size > bytes)
      buffer->size = bytes;
    else
      throw MemoryRefused(std::string(source_.name) + " refused " + describe_bytes(bytes) + " of memory for the mesh");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  bytes_ += buffer->size;
  return buffer;
}

std::unique_ptr<MeshBuffer> MeshPool::take_spare(size_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++takes_;
  const auto best = spares_.begin() + (best_spare(bytes) - spares_.cbegin());
  if (best == spares_.end()) return nullptr;
  std::unique_ptr<MeshBuffer> buffer = std::move(*best);
  spares_.erase(best);
  return buffer;
}

MeshPool::Spares::const_iterator MeshPool::best_spare(size_t bytes) const {
  auto best = spares_.cend();
  for (auto spare = spares_.cbegin(); spare != spares_.cend(); ++spare)
    if ((*spare)->size >= bytes && (*spare)->size <= std::max(kSmall, kMostTooLarge * bytes) &&
        (best == spares_.cend() || (*spare)->size <= (*best)->size))
      best = spare;
  return best;
}

std::unique_ptr<MeshBuffer> MeshPool::oldest_spare() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (spares_.empty()) return nullptr;
  std::unique_ptr<MeshBuffer> buffer = std::move(spares_.front());
  spares_.erase(spares_.begin());
  return buffer;
}

void MeshPool::give_back(std::unique_ptr<MeshBuffer> buffer) noexcept {
  std::unique_ptr<MeshBuffer> surplus[kMostSpares + 1];  // released outside of the lock: drivers take their time
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    buffer->last_take = takes_;
    spares_.push_back(std::move(buffer));
    size_t k = 0;
    while (has_surplus()) {
      surplus[k++] = std::move(spares_.front());
      spares_.erase(spares_.begin());
    }
  }
  for (const auto &one : surplus)
    if (one) release(*one, source_.release_later ? source_.release_later : source_.release);
}

bool MeshPool::has_surplus() const {
  size_t sum = 0, largest = 0;
  for (const auto &spare : spares_) {
    sum += spare->size;
    largest = std::max(largest, spare->size);
  }
  if (spares_.empty()) return false;
  return is_closed_ || spares_.size() > kMostSpares || sum > source_.most_of_the_largest * largest ||
         takes_ - spares_.front()->last_take > kMostPassedBy;
}

void MeshPool::close() noexcept {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_closed_ = true;
  }
  drop_spares();
}

void MeshPool::drop_spares() noexcept {
  while (const std::unique_ptr<MeshBuffer> spare = oldest_spare()) release(*spare, source_.release);
}

uint64_t MeshPool::bytes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return bytes_;
}

uint64_t MeshPool::bytes_with(size_t bytes) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return best_spare(bytes) != spares_.cend() ? bytes_ : bytes_ + size_for(bytes);
}

void MeshPool::count_numbers(int64_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  bytes_ += static_cast<uint64_t>(bytes);
}

void MeshPool::release(MeshBuffer &buffer, const Release &release_memory) noexcept {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_ -= buffer.size + buffer.components.size() + buffer.atom_areas.size();
  }
  if (buffer.memory) release_memory(buffer);
}

MeshLease::MeshLease(std::shared_ptr<MeshPool> pool, size_t bytes) : buffer_(pool->take(bytes)) {
  pool_ = std::move(pool);
}

MeshLease &MeshLease::operator=(MeshLease &&other) noexcept {
  if (this == &other) return *this;
  give_back();
  pool_ = std::move(other.pool_);
  buffer_ = std::move(other.buffer_);
  return *this;
}

void MeshLease::give_back() noexcept {
  if (buffer_) pool_->give_back(std::move(buffer_));
  pool_.reset();
}

const void *MeshLease::add(Numbers which, const void *numbers, size_t bytes) {
  GrowingBuffer<HostMemory> &room = which == kComponents ? buffer_->components : buffer_->atom_areas;
  const size_t before = room.size();
  const bool is_there = room.try_reserve(bytes);
  pool_->count_numbers(static_cast<int64_t>(room.size()) - static_cast<int64_t>(before));
  if (!is_there)
    throw MemoryRefused("the machine refused memory for the components of the mesh or the areas of its atoms");
  if (bytes > 0) std::memcpy(room.data(), numbers, bytes);
  return room.data();
}

}  // namespace quickses
