// SPDX-License-Identifier: MIT
// Kept meshes for tests.
#pragma once

#include "capi/capi_fixture.h"

namespace kept_mesh_fixture {

using namespace capi_fixture;

// A kept mesh that ends with the scope.
class Kept {
 public:
  Kept() { expect_ok(qses_kept_mesh_create(&kept_)); }
  ~Kept() { qses_kept_mesh_destroy(kept_); }
  Kept(const Kept &) = delete;
  Kept &operator=(const Kept &) = delete;
  operator qses_kept_mesh *() const { return kept_; }

  qses_mesh view() const {
    qses_mesh mesh = empty_mesh();
    expect_ok(qses_kept_mesh_view(kept_, &mesh));
    return mesh;
  }

 private:
  qses_kept_mesh *kept_ = nullptr;
};

// The mesh of some atoms, kept; the context it was computed in has gone.
class KeptSurface : public Kept {
 public:
  explicit KeptSurface(const Atoms &atoms) {
    const Context context;
    set_atoms(context, atoms);
    compute_view(context, settings());
    expect_ok(qses_keep(context, *this));
  }
};

inline std::vector<uint8_t> some_visible(size_t atoms, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<uint8_t> visible(atoms);
  for (uint8_t &v : visible) v = random() % 4 != 0 ? 1 : 0;
  return visible;
}

// Whether what filter and pick leave out is left out.
inline bool is_shown(const qses_mesh &m, uint32_t triangle, const uint8_t *visible) {
  for (int k = 0; k < 3 && visible; ++k)
    if (!visible[m.owners[m.indices[3 * size_t(triangle) + size_t(k)]]]) return false;
  return true;
}

}  // namespace kept_mesh_fixture
