// SPDX-License-Identifier: MIT
// What the tests of the C API share.
#pragma once

#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <cstring>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace capi_fixture {

using namespace surface_fixture;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// The call failed with this status, and its sentence contains all these words.
inline void expect_error(qses_status status, qses_status expected, std::initializer_list<const char *> words) {
  EXPECT_EQ(status, expected) << qses_last_error();
  const std::string message = qses_last_error();
  EXPECT_FALSE(message.empty());
  for (const char *word : words)
    EXPECT_NE(message.find(word), std::string::npos) << '"' << message << "\" lacks " << word;
}

// Numbers that an enumeration does not have, as a C caller may pass them.
template <class Choice>
void set_any(Choice *choice, int32_t value) {
  static_assert(sizeof *choice == sizeof value, "an int in C");
  std::memcpy(choice, &value, sizeof value);
}

inline Atoms water() { return Atoms().add(0, 0, 0, 1.52).add(0.96, 0, 0, 1.2).add(-0.24, 0.93, 0, 1.2); }

inline qses_mesh empty_mesh() {
  qses_mesh m;
  qses_mesh_init(&m);
  return m;
}

inline qses_backend_description empty_description() {
  qses_backend_description d;
  qses_backend_description_init(&d);
  return d;
}

// A context with a good mesh in it, to prove that errors do not touch it.
class WithMesh : public testing::Test {
 protected:
  WithMesh() {
    set_atoms(context_, water());
    const qses_settings s = settings();
    expect_ok(qses_compute(context_, &s, &mesh_));
    before_ = copy_surface(context_);
  }

  // Everything handed out before is as it was, and the context computes again.
  void expect_unharmed() {
    qses_mesh now = empty_mesh();
    ASSERT_EQ(qses_context_mesh(context_, &now), QSES_OK);
    EXPECT_EQ(now.positions, mesh_.positions);
    EXPECT_EQ(now.indices, mesh_.indices);
    const Surface after = copy_surface(context_);
    EXPECT_EQ(after.mesh.positions, before_.mesh.positions);
    EXPECT_EQ(after.mesh.normals, before_.mesh.normals);
    EXPECT_EQ(after.mesh.owners, before_.mesh.owners);
    EXPECT_EQ(after.mesh.indices, before_.mesh.indices);
    EXPECT_EQ(after.report.volume, before_.report.volume);
  }
  void expect_usable() {
    ASSERT_EQ(qses_compute(context_, nullptr, nullptr), QSES_OK) << qses_last_error();
    const Surface again = copy_surface(context_);
    EXPECT_EQ(again.mesh.positions, before_.mesh.positions);
    EXPECT_EQ(again.mesh.indices, before_.mesh.indices);
  }

  Context context_;
  qses_mesh mesh_ = empty_mesh();
  Surface before_;
};

}  // namespace capi_fixture
