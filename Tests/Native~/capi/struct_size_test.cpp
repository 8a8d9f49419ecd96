// SPDX-License-Identifier: MIT
// Callers that were compiled with an older header than the library, whose structures are shorter, or with a newer one,
// whose structures are longer: nothing behind a caller's structure is read or written, and defaults are the caller's.
#include "capi/capi_fixture.h"
#include "capi/structs.h"

#include <cstddef>
#include <cstring>
#include <functional>
#include <type_traits>
#include <vector>

namespace {

using namespace capi_fixture;

constexpr unsigned char kCanary = 0xcc;
constexpr size_t kMore = 64;  // bytes that newer headers may have in addition

const char kText[] =
    "CRYST1   30.000   30.000   30.000  90.00  90.00  90.00 P 1           1\n"
    "MODEL        1\n"
    "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n"
    "ENDMDL\n";

// What the tests ask, ready to answer.
struct Library {
  Library() {
    set_atoms(context, water());
    expect_ok(qses_compute(context, nullptr, nullptr));
    qses_structure_options options;
    qses_structure_options_init(&options);
    options.format = QSES_STRUCTURE_PDB;
    expect_ok(qses_structure_open_memory(kText, sizeof kText - 1, &options, &structure));
    expect_ok(qses_trajectory_open_memory(kText, sizeof kText - 1, QSES_TRAJECTORY_PDB, &trajectory));
  }
  ~Library() {
    qses_structure_close(structure);
    qses_trajectory_close(trajectory);
  }
  Context context;
  qses_structure *structure = nullptr;
  qses_trajectory *trajectory = nullptr;
};

// A structure in memory of its own, as long as the caller's header says, with canaries behind it.
template <class T>
class Room {
 public:
  Room(size_t size, void (*init)(T *)) : size_(size) {
    std::memset(bytes_, kCanary, sizeof bytes_);
    T whole;
    init(&whole);
    EXPECT_EQ(whole.struct_size, sizeof whole);
    std::memcpy(bytes_, &whole, std::min(size, sizeof whole));
    if (size > sizeof whole) std::memset(bytes_ + sizeof whole, 0, size - sizeof whole);  // as the newer init does
    set_size(static_cast<uint32_t>(size));
  }
  T *get() { return reinterpret_cast<T *>(bytes_); }
  const unsigned char *bytes() const { return bytes_; }
  unsigned char &operator[](size_t k) { return bytes_[k]; }
  void set_size(uint32_t size) { std::memcpy(bytes_, &size, sizeof size); }
  uint32_t struct_size() const {
    uint32_t size;
    std::memcpy(&size, bytes_, sizeof size);
    return size;
  }
  bool canaries_live() const {
    for (size_t k = size_; k < sizeof bytes_; ++k)
      if (bytes_[k] != kCanary) return false;
    return true;
  }

 private:
  alignas(16) unsigned char bytes_[sizeof(T) + 2 * kMore];
  size_t size_;
};

template <class T>
using Call = std::function<qses_status(T *)>;

// The last one may cut a pointer in two.
template <class T>
std::vector<uint32_t> impossible_sizes() {
  return {0u, 1u, 3u, 4u, 7u, 9u, 4100u, 0xccccccccu, static_cast<uint32_t>(sizeof(T) - alignof(T) / 2)};
}

// A structure that the library fills in, for callers with every length from the least on.
template <class T>
void check_output(const char *name, void (*init)(T *), const Call<T> &fill) {
  SCOPED_TRACE(name);
  Room<T> whole(sizeof(T), init);
  ASSERT_EQ(fill(whole.get()), QSES_OK) << qses_last_error();
  EXPECT_TRUE(whole.canaries_live());
  EXPECT_NE(std::memcmp(whole.bytes(), Room<T>(sizeof(T), init).bytes(), sizeof(T)), 0) << "nothing was filled in";
  for (size_t size = 8; size <= sizeof(T) + kMore; size += alignof(T)) {
    Room<T> room(size, init);
    ASSERT_EQ(fill(room.get()), QSES_OK) << size << ": " << qses_last_error();
    EXPECT_TRUE(room.canaries_live()) << size;
    EXPECT_EQ(room.struct_size(), size);
    EXPECT_EQ(std::memcmp(room.bytes() + 4, whole.bytes() + 4, std::min(size, sizeof(T)) - 4), 0) << size;
    for (size_t k = sizeof(T); k < size; ++k) EXPECT_EQ(room[k], 0) << k << ": not the library's to write";
  }
  for (const uint32_t size : impossible_sizes<T>()) {
    Room<T> room(sizeof(T), init), before = room;
    room.set_size(size);
    before.set_size(size);
    expect_error(fill(room.get()), QSES_INVALID_ARGUMENT, {name, "struct_size", std::to_string(size).c_str()});
    EXPECT_EQ(std::memcmp(room.bytes(), before.bytes(), sizeof(T)), 0) << size;
  }
}

TEST(StructSize, OfWhatIsFilledIn) {
  const Library library;
  qses_context *const context = library.context;
  check_output<qses_backend_description>(
      "qses_backend_description", qses_backend_description_init,
      [&](qses_backend_description *d) { return qses_context_info(context, nullptr, d); });
  check_output<qses_mesh>("qses_mesh", qses_mesh_init, [&](qses_mesh *m) { return qses_context_mesh(context, m); });
  check_output<qses_report>("qses_report", qses_report_init,
                            [&](qses_report *r) { return qses_context_report(context, r); });
  check_output<qses_size_estimate>("qses_size_estimate", qses_size_estimate_init,
                                   [&](qses_size_estimate *e) { return qses_estimate(context, nullptr, e); });
  check_output<qses_progress>("qses_progress", qses_progress_init,
                              [&](qses_progress *p) { return qses_poll(context, p); });
  check_output<qses_structure_description>(
      "qses_structure_description", qses_structure_description_init,
      [&](qses_structure_description *d) { return qses_structure_info(library.structure, d); });
  check_output<qses_atom>("qses_atom", qses_atom_init,
                          [&](qses_atom *a) { return qses_structure_atom(library.structure, 0, a); });
  check_output<qses_trajectory_description>(
      "qses_trajectory_description", qses_trajectory_description_init,
      [&](qses_trajectory_description *d) { return qses_trajectory_info(library.trajectory, d); });
  check_output<qses_frame>("qses_frame", qses_frame_init, [&](qses_frame *f) {
    float xyz[3];
    return qses_trajectory_read_frame(library.trajectory, 0, xyz, 0, 1, f);
  });
}

// A structure in a structure: the sizes of both stay the caller's. (A mesh on a device is there with CUDA only.)
TEST(StructSize, OfAMeshOnADevice) {
  qses_device_mesh filled;
  qses_device_mesh_init(&filled);
  filled.device = 3;
  filled.mesh.vertex_count = 7;
  filled.mesh.positions = reinterpret_cast<const float *>(&filled);
  const auto fill = [&](qses_device_mesh *mesh) {
    return quickses::guarded([&] { quickses::write_device_mesh(mesh, filled); });
  };
  check_output<qses_device_mesh>("qses_device_mesh", qses_device_mesh_init, fill);
  for (const size_t more : {size_t(0), kMore}) {
    qses_device_mesh mesh;
    qses_device_mesh_init(&mesh);
    const auto inner = static_cast<uint32_t>(more ? sizeof mesh.mesh + more : offsetof(qses_mesh, indices));
    mesh.mesh.struct_size = inner;
    expect_ok(fill(&mesh));
    EXPECT_EQ(mesh.mesh.struct_size, inner);
    EXPECT_EQ(mesh.mesh.vertex_count, 7u);
  }
}

const float *held_positions(qses_context *context) {
  qses_mesh mesh = empty_mesh();
  expect_ok(qses_context_mesh(context, &mesh));
  return mesh.positions;
}

// The same where the mesh comes with the computation: it is not replaced if it could not be handed out.
TEST(StructSize, OfTheMeshThatIsComputed) {
  const Context context;
  set_atoms(context, water());
  for (size_t size : {offsetof(qses_mesh, normals), sizeof(qses_mesh), sizeof(qses_mesh) + kMore}) {
    Room<qses_mesh> computed(size, qses_mesh_init), collected(size, qses_mesh_init);
    ASSERT_EQ(qses_compute(context, nullptr, computed.get()), QSES_OK);
    EXPECT_GT(computed.get()->vertex_count, 0u);
    EXPECT_TRUE(computed.canaries_live());
    expect_ok(qses_begin(context, nullptr));
    expect_ok(qses_wait(context, -1, nullptr));
    const float *const before = held_positions(context);
    collected.set_size(0);
    expect_error(qses_collect(context, collected.get()), QSES_INVALID_ARGUMENT, {"qses_mesh", "struct_size"});
    expect_error(qses_compute(context, nullptr, collected.get()), QSES_INVALID_ARGUMENT, {"qses_mesh", "struct_size"});
    EXPECT_EQ(held_positions(context), before);
    collected.set_size(static_cast<uint32_t>(size));
    ASSERT_EQ(qses_collect(context, collected.get()), QSES_OK);
    EXPECT_TRUE(collected.canaries_live());
    EXPECT_EQ(collected.struct_size(), size);
  }
}

// A structure that the library reads: a caller of every length gets its defaults, and what it sets.
template <class T>
void check_input(const char *name, void (*init)(T *), const Call<T> &use) {
  SCOPED_TRACE(name);
  for (size_t size = 8; size <= sizeof(T) + kMore; size += alignof(T)) {
    Room<T> room(size, init);
    EXPECT_EQ(use(room.get()), QSES_OK) << size << ": " << qses_last_error();  // the canaries would be absurd
    for (size_t k = sizeof(T); k < size; ++k) {
      room[k] = 1;
      expect_error(use(room.get()), QSES_INVALID_ARGUMENT, {name, std::to_string(k).c_str()});
      room[k] = 0;
    }
  }
  for (const uint32_t size : impossible_sizes<T>()) {
    Room<T> room(sizeof(T), init);
    room.set_size(size);
    expect_error(use(room.get()), QSES_INVALID_ARGUMENT, {name, "struct_size", std::to_string(size).c_str()});
  }
}

TEST(StructSize, OfWhatIsRead) {
  const Library library;
  check_input<qses_context_options>("qses_context_options", qses_context_options_init, [](qses_context_options *o) {
    qses_context *context = nullptr;
    const qses_status status = qses_context_create(o, &context);
    qses_context_destroy(context);
    return status;
  });
  for (const auto call : {qses_compute, +[](qses_context *context, const qses_settings *s, qses_mesh *) {
                            const qses_status status = qses_begin(context, s);
                            expect_ok(qses_wait(context, -1, nullptr));
                            return status;
                          }})
    check_input<qses_settings>("qses_settings", qses_settings_init,
                               [&](qses_settings *s) { return call(library.context, s, nullptr); });
  check_input<qses_structure_options>(
      "qses_structure_options", qses_structure_options_init, [](qses_structure_options *o) {
        qses_structure *structure = nullptr;
        const qses_status status = qses_structure_open_memory(kText, sizeof kText - 1, o, &structure);
        qses_structure_close(structure);
        return status;
      });
}

TEST(StructSize, OldSettingsHaveTheirOwnValuesAndDefaultsBehind) {
  const Context context;
  set_atoms(context, water());
  const size_t size = offsetof(qses_settings, relaxation_steps);
  Room<qses_settings> old(size, qses_settings_init);
  old.get()->spacing = 0.3f;
  old.get()->probe_radius = 0.9f;
  ASSERT_EQ(qses_compute(context, old.get(), nullptr), QSES_OK) << qses_last_error();
  EXPECT_EQ(copy_surface(context).mesh.positions, compute(water(), settings(0.3, 0.9)).mesh.positions);
}

TEST(StructSize, NewSettingsAreReadAsFarAsTheyAreKnown) {
  const Context context;
  set_atoms(context, water());
  Room<qses_settings> newer(sizeof(qses_settings) + kMore, qses_settings_init);
  newer.get()->spacing = 0.3f;
  newer.get()->series = 3;  // the last field
  ASSERT_EQ(qses_compute(context, newer.get(), nullptr), QSES_OK) << qses_last_error();
  EXPECT_EQ(copy_surface(context).mesh.positions, compute(water(), settings(0.3)).mesh.positions);
}

TEST(StructSize, ErrorsLeaveTheContextAsItWas) {
  const Library library;
  const Surface before = copy_surface(library.context);
  qses_settings s = settings(0.3);
  s.struct_size = 0;
  expect_error(qses_compute(library.context, &s, nullptr), QSES_INVALID_ARGUMENT, {"qses_settings"});
  expect_error(qses_begin(library.context, &s), QSES_INVALID_ARGUMENT, {"qses_settings"});
  EXPECT_EQ(copy_surface(library.context).mesh.positions, before.mesh.positions);
  EXPECT_EQ(qses_compute(library.context, nullptr, nullptr), QSES_OK);
}

TEST(Init, WritesDefaultsAndNothingBehind) {
  qses_settings s[2];
  std::memset(s, kCanary, sizeof s);
  qses_settings_init(s);
  EXPECT_EQ(s[0].struct_size, sizeof s[0]);
  EXPECT_EQ(s[0].surface, QSES_SURFACE_SES);
  EXPECT_EQ(s[0].method, QSES_METHOD_EXACT);
  EXPECT_EQ(s[0].probe_radius, 1.4f);
  EXPECT_EQ(s[0].spacing, 0.5f);
  EXPECT_EQ(s[0].relaxation_steps, 1u);
  EXPECT_EQ(s[0].slice_size, 0u);
  EXPECT_EQ(s[0].winding, QSES_WINDING_OUTWARD);
  EXPECT_EQ(s[0].patch_types, 0);
  EXPECT_EQ(s[0].measure, 1);
  EXPECT_EQ(s[0].tag, 0u);
  EXPECT_EQ(s[0].level_count, 2u);
  EXPECT_EQ(s[0].levels[0], 2.f);
  EXPECT_EQ(s[0].levels[1], 1.f);
  EXPECT_EQ(s[0].components, 0);
  EXPECT_EQ(s[0].occlusion, 0);
  EXPECT_EQ(s[0].gaussian_radius_scale, 1.f);
  EXPECT_EQ(s[0].gaussian_isovalue, 0.5f);
  EXPECT_EQ(s[0].without_owners, 0);
  EXPECT_EQ(*reinterpret_cast<unsigned char *>(&s[1]), kCanary);
  qses_settings_init(nullptr);
  qses_mesh_init(nullptr);
  qses_report_init(nullptr);
  qses_structure_options_init(nullptr);
}

// Where a later field would go, an older caller has nothing but its own memory: no structure may end in padding.
template <class T>
constexpr bool is_without_padding(size_t end_of_last_field) {
  return end_of_last_field == sizeof(T) && std::is_trivially_copyable<T>::value;
}
#define END(type, field) (offsetof(type, field) + sizeof(type::field))
static_assert(is_without_padding<qses_backend_description>(END(qses_backend_description, processors)), "");
static_assert(is_without_padding<qses_context_options>(END(qses_context_options, reserved)), "");
static_assert(is_without_padding<qses_settings>(END(qses_settings, without_owners)), "");
static_assert(is_without_padding<qses_component>(END(qses_component, bounds_max)), "");
static_assert(is_without_padding<qses_mesh>(END(qses_mesh, reserved2)), "");
static_assert(is_without_padding<qses_device_mesh>(END(qses_device_mesh, mesh)), "");
static_assert(is_without_padding<qses_stage_time>(END(qses_stage_time, milliseconds)), "");
static_assert(is_without_padding<qses_report>(END(qses_report, reserved)), "");
static_assert(is_without_padding<qses_size_estimate>(END(qses_size_estimate, smallest_budget)), "");
static_assert(is_without_padding<qses_progress>(END(qses_progress, message)), "");
static_assert(is_without_padding<qses_hit>(END(qses_hit, normal)), "");
static_assert(is_without_padding<qses_structure_options>(END(qses_structure_options, altloc)), "");
static_assert(is_without_padding<qses_structure_description>(END(qses_structure_description, residues)), "");
static_assert(is_without_padding<qses_atom>(END(qses_atom, reserved)), "");
static_assert(is_without_padding<qses_trajectory_description>(END(qses_trajectory_description, reserved)), "");
static_assert(is_without_padding<qses_frame>(END(qses_frame, box)), "");

}  // namespace
