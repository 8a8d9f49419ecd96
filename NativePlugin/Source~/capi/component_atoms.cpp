// SPDX-License-Identifier: MIT
// The part of the C API that tells which atoms line the components of a mesh.
#include "capi/barrier.h"
#include "capi/structs.h"
#include "io/text.h"

#include <algorithm>
#include <vector>

using quickses::guarded;
using quickses::invalid;
using quickses::require;
using quickses::require_owners;

namespace {

// Atoms of each component, rising, and where those of each begin.
struct Lining {
  std::vector<uint32_t> atoms, starts;
};

Lining find_lining(const qses_mesh &mesh) {
  const uint32_t count = mesh.component_count;
  std::vector<uint32_t> place(size_t(count) + 1, 0);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    if (mesh.component_ids[v] >= count) invalid("mesh.component_ids names a component that is not there");
    ++place[mesh.component_ids[v] + 1];
  }
  for (uint32_t k = 0; k < count; ++k) place[k + 1] += place[k];
  Lining lining;
  lining.atoms.resize(mesh.vertex_count);
  const std::vector<uint32_t> first = place;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) lining.atoms[place[mesh.component_ids[v]]++] = mesh.owners[v];
  lining.starts.assign(1, 0);
  const auto begin = lining.atoms.begin();
  auto out = begin;
  for (uint32_t k = 0; k < count; ++k) {
    std::sort(begin + first[k], begin + first[k + 1]);
    out = std::move(begin + first[k], std::unique(begin + first[k], begin + first[k + 1]), out);
    lining.starts.push_back(static_cast<uint32_t>(out - begin));
  }
  lining.atoms.erase(out, lining.atoms.end());
  return lining;
}

}  // namespace

extern "C" {

qses_status qses_component_atoms(const qses_mesh *mesh, uint32_t *starts, uint32_t *atoms, size_t room) {
  return guarded([&] {
    require(mesh, "mesh");
    require(starts, "starts");
    const qses_mesh m = quickses::read_struct(mesh, qses_mesh_init, "qses_mesh");
    if (m.vertex_count > 0 && !m.component_ids)
      invalid("mesh has no component_ids in host memory: settings.component_ids asks for them");
    require_owners(m);
    const Lining lining = find_lining(m);
    std::copy(lining.starts.begin(), lining.starts.end(), starts);
    if (!atoms) return;
    if (room < lining.atoms.size())
      invalid("room is " + std::to_string(room) + " but the components have " +
              quickses::io::counted(lining.atoms.size(), "atom"));
    std::copy(lining.atoms.begin(), lining.atoms.end(), atoms);
  });
}

}  // extern "C"
