// SPDX-License-Identifier: MIT
// The connected pieces of a mesh, listed (component_labels.h, component_sums.h): outer surfaces enclose a positive
// volume, cavities a negative one.
#pragma once

#include "parallel/growing_buffer.h"
#include "process/host_memory.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/component_sums.h"
#include "surface/stages/host_components.h"

#include <algorithm>

namespace quickses {

// Host memory for the components of one mesh. It only grows.
class ComponentMemory {
 public:
  // For n components, in memory of the next call of each.
  Span<ComponentSums> sums(size_t n) {
    return {static_cast<ComponentSums *>(sums_.reserve(n * sizeof(ComponentSums))), n};
  }
  Span<qses_component> list(size_t n) {
    return {static_cast<qses_component *>(list_.reserve(n * sizeof(qses_component))), n};
  }
  Span<uint8_t> flags(size_t n) { return {static_cast<uint8_t *>(flags_.reserve(n)), n}; }
  uint64_t bytes() const { return sums_.size() + list_.size() + flags_.size(); }

 private:
  GrowingBuffer<HostMemory> sums_, list_, flags_;
};

// Whether anything asks for them.
inline bool wants_components(const qses_settings &s) { return s.components || s.component_ids || s.outer_only; }

// The components in the order of their first vertices; valid until the next call with the same memory.
struct MeshComponents {
  Span<const qses_component> list;
  Measures total;
};

// If the mesh has room for their numbers, vertices get them. unplaced, unplaced_found: the mesh's number of
// vertices without a feature, in memory of the back end, and where it goes; or nullptr. Waits.
template <class Executor>
MeshComponents find_components(Executor &executor, const MeshView &mesh, const MeshCounts &counts, float spacing,
                               bool bent, ComponentMemory &memory, const uint32_t *unplaced = nullptr,
                               uint64_t *unplaced_found = nullptr) {
  if (counts.triangles == 0) return {};
  const auto mark = executor.arena().mark();
  const size_t n = counts.vertices;
  const Span<uint32_t> labels = executor.template allocate<uint32_t>(n);
  Tally<uint32_t> *const components_found = executor.template take_counts<Tally<uint32_t>>();
  label_components(executor, mesh, counts, labels.data, components_found);
  const Span<uint32_t> number_of_root = executor.template allocate<uint32_t>(n + 1);
  executor.exclusive_scan(n, IsRoot{labels.data}, number_of_root);
  size_t count = executor.expect("components", components_found, Tally<uint32_t>{static_cast<uint32_t>(n)}).count;
  const ComponentNumbers number_of{number_of_root.data, static_cast<uint32_t>(count)};

  const Span<ComponentSums> found = memory.sums(count);
  const Span<ComponentSums> sums = Executor::kIsCuda ? executor.template allocate<ComponentSums>(count) : found;
  executor.fill(sums, 0);
  executor.for_each(n, NumberComponents{mesh, labels.data, number_of, unplaced, sums.data});
  const double h = static_cast<double>(spacing), units = rest_units(counts.triangles);
  const size_t chunk = reduce_chunk(counts.triangles);
  executor.template for_each_brick<ChunkSums>(
      reduce_chunks(counts.triangles),
      SumComponents{mesh, counts.triangles, chunk, labels.data, number_of, 1.0 / h, units, bent, sums.data}, 1);
  executor.send_counts();  // they come with what is waited for
  executor.fetch_all(found.data, sums.data, count);
  executor.arena().rewind(mark);
  while (count > 0 && found[count - 1].triangles == 0) --count;  // there are fewer than anticipated

  MeshComponents components{};
  const Span<qses_component> list = memory.list(count);
  for (size_t k = 0; k < count; ++k) {
    list[k] = describe_component(found[k], units, h);
    components.total.sums += measured_sums(found[k], units, h);
    const Bounds bounds = bounds_of(found[k]);
    for (int d = 0; d < 3; ++d) {
      float &low = components.total.bounds.min[d], &high = components.total.bounds.max[d];
      low = k == 0 ? bounds.min[d] : std::min(low, bounds.min[d]);
      high = k == 0 ? bounds.max[d] : std::max(high, bounds.max[d]);
    }
  }
  components.list = {list.data, count};
  if (unplaced && unplaced_found && count > 0) *unplaced_found = found[0].unplaced;
  return components;
}

// Finds them where the mesh is, with memory that is kept: on the device, or, for a mesh that left it in pieces, by the
// CPU's threads. The numbers are the same.
class ComponentFinder {
 public:
  // threads: used only for meshes that left the device.
  explicit ComponentFinder(const WorkerThreads &threads) : on_host_(threads) {}
  // unplaced: gets the mesh's number of them, if it has one. stop: for the CPU's threads.
  template <class Executor>
  MeshComponents find(Executor &executor, const MeshMemoryView &mesh, float spacing, bool bent, uint64_t *unplaced,
                      const std::atomic<bool> *stop) {
    const MeshCounts counts{mesh.vertices, mesh.triangles};
    if (!mesh.in_pieces)
      return find_components(executor, mesh.view, counts, spacing, bent, memory_, mesh.unplaced, unplaced);
    if (Executor::kCounts) return {};
    if (mesh.unplaced) *unplaced = executor.fetch(mesh.unplaced);
    executor.wait();
    return on_host_.find(mesh.view, counts, spacing, bent, memory_, *stop);
  }
  // Of each component whether it is no cavity; valid until the next call.
  Span<const uint8_t> outer(Span<const qses_component> components) {
    const Span<uint8_t> flags = memory_.flags(components.size);
    for (size_t k = 0; k < flags.size; ++k) flags[k] = components[k].is_cavity ? 0 : 1;
    return {flags.data, flags.size};
  }
  uint64_t bytes() const { return memory_.bytes() + on_host_.bytes(); }

 private:
  ComponentMemory memory_;
  HostComponents on_host_;
};

}  // namespace quickses
