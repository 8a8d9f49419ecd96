// SPDX-License-Identifier: MIT
// From the fourth frame of a trajectory on nothing is allocated. Every allocation of the process is counted, in all
// threads: this program has its own malloc and operator new, which count and hand on to the C library's.
#include "io/trajectory_frames.h"

#include <gtest/gtest.h>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAN_COUNT_ALLOCATIONS 1
#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#else
#define CAN_COUNT_ALLOCATIONS 0
#endif

#include <atomic>
#include <cerrno>
#include <new>

using namespace surface_fixture;

namespace {

constexpr size_t kRemembered = 256;
std::atomic<bool> counting{false};
std::atomic<size_t> counted{0};
const void *callers[kRemembered];

#if CAN_COUNT_ALLOCATIONS
void note(const void *caller) {
  if (!counting.load(std::memory_order_relaxed)) return;
  const size_t k = counted.fetch_add(1);
  if (k < kRemembered) callers[k] = caller;
}
#endif

// Allocations while it lives, by who asked for them.
class Count {
 public:
  Count() {
    counted = 0;
    counting = true;
  }
  ~Count() { counting = false; }

  struct Result {
    size_t total = 0;
    std::string callers;
  };
  Result end() {
    counting = false;
    Result result;
    result.total = counted;
#if CAN_COUNT_ALLOCATIONS
    for (size_t k = 0; k < std::min(result.total, kRemembered); ++k) {
      Dl_info info{};
      const bool found = dladdr(callers[k], &info) != 0 && info.dli_fname;
      char text[400];
      std::snprintf(
          text, sizeof text, "%s+0x%zx (%s)\n", found ? info.dli_fname : "?",
          found ? static_cast<size_t>(static_cast<const char *>(callers[k]) - static_cast<const char *>(info.dli_fbase))
                : 0,
          found && info.dli_sname ? info.dli_sname : "");
      result.callers += text;
    }
#endif
    return result;
  }
};

}  // namespace

#if CAN_COUNT_ALLOCATIONS
#define CALLER __builtin_return_address(0)

extern "C" {
void *__libc_malloc(size_t);
void __libc_free(void *);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);

void *malloc(size_t n) {
  note(CALLER);
  return __libc_malloc(n);
}
void *calloc(size_t n, size_t size) {
  note(CALLER);
  return __libc_calloc(n, size);
}
void *realloc(void *p, size_t n) {
  note(CALLER);
  return __libc_realloc(p, n);
}
void *memalign(size_t alignment, size_t n) {
  note(CALLER);
  return __libc_memalign(alignment, n);
}
void *aligned_alloc(size_t alignment, size_t n) {
  note(CALLER);
  return __libc_memalign(alignment, n);
}
int posix_memalign(void **p, size_t alignment, size_t n) {
  note(CALLER);
  *p = __libc_memalign(alignment, n);
  return *p ? 0 : ENOMEM;
}
// What libraries map on their own account; the C library's own calls do not pass here.
void *mmap(void *address, size_t n, int protection, int flags, int file, off_t offset) {
  note(CALLER);
  return reinterpret_cast<void *>(syscall(SYS_mmap, address, n, protection, flags, file, offset));
}
}

namespace {
void *counted_new(size_t n, size_t alignment, const void *caller) {
  note(caller);
  void *p = alignment > alignof(std::max_align_t) ? __libc_memalign(alignment, n) : __libc_malloc(n ? n : 1);
  if (!p) throw std::bad_alloc();
  return p;
}
}  // namespace

void *operator new(size_t n) { return counted_new(n, 0, CALLER); }
void *operator new[](size_t n) { return counted_new(n, 0, CALLER); }
void *operator new(size_t n, std::align_val_t a) { return counted_new(n, static_cast<size_t>(a), CALLER); }
void *operator new[](size_t n, std::align_val_t a) { return counted_new(n, static_cast<size_t>(a), CALLER); }
void operator delete(void *p) noexcept { __libc_free(p); }
void operator delete[](void *p) noexcept { __libc_free(p); }
void operator delete(void *p, size_t) noexcept { __libc_free(p); }
void operator delete[](void *p, size_t) noexcept { __libc_free(p); }
void operator delete(void *p, std::align_val_t) noexcept { __libc_free(p); }
void operator delete[](void *p, std::align_val_t) noexcept { __libc_free(p); }
void operator delete(void *p, size_t, std::align_val_t) noexcept { __libc_free(p); }
void operator delete[](void *p, size_t, std::align_val_t) noexcept { __libc_free(p); }
#endif

namespace {

constexpr int kFramesBefore = 3;

// Runs frames of a trajectory: the first three as they like, the others counted.
template <class Frame>
void expect_no_allocation(const Atoms &atoms, const Frame &frame, int frames = 30) {
  Trajectory trajectory(atoms);
  for (int k = 0; k < kFramesBefore; ++k) frame(trajectory.next());
  Count count;
  for (int k = 0; k < frames; ++k) frame(trajectory.next());
  const Count::Result found = count.end();
  EXPECT_EQ(found.total, 0u) << found.callers;
}

class Allocations : public testing::Test {
 protected:
  void SetUp() override {
    if (!CAN_COUNT_ALLOCATIONS) GTEST_SKIP() << "allocations can't be counted in this build";
    if (tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "the driver of the GPU allocates as it likes";
  }
};

TEST_F(Allocations, AreCounted) {
  Count count;
  void *volatile taken = std::malloc(10);  // or compilers leave it out
  std::free(taken);
  int *volatile made = new int;
  delete made;
  std::vector<float>(100).swap(*std::make_unique<std::vector<float>>());
  EXPECT_GE(count.end().total, 4u);
}

TEST_F(Allocations, NoneInJobsOverATrajectory) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  expect_no_allocation(atoms, [&](const std::vector<float> &positions) {
    set_positions(context, positions);
    begin_and_collect(context, settings());
    qses_mesh m;
    qses_mesh_init(&m);
    EXPECT_EQ(qses_collect(context, &m), QSES_NOTHING_NEW);  // what an application hears in most of its frames
  });
}

TEST_F(Allocations, NoneInComputeOverATrajectory) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  expect_ok(qses_set_stage_times(context, 1));
  qses_settings s = settings();
  s.relaxation_steps = 3;
  s.patch_types = 1;
  expect_no_allocation(atoms, [&](const std::vector<float> &positions) {
    set_positions(context, positions);
    qses_mesh m;
    qses_mesh_init(&m);
    expect_ok(qses_compute(context, &s, &m));
    qses_report r;
    qses_report_init(&r);
    expect_ok(qses_context_report(context, &r));
  });
}

TEST_F(Allocations, NoneWithTheGridMethodAndGatheredPositions) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  qses_settings s = settings();
  s.method = QSES_METHOD_GRID;
  std::vector<uint32_t> indices(atoms.size());
  for (size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<uint32_t>(i);
  expect_no_allocation(atoms, [&](const std::vector<float> &positions) {
    expect_ok(qses_set_positions_indexed(context, positions.data(), 0, atoms.size(), indices.data(), indices.size()));
    begin_and_collect(context, s);
  });
}

// Atoms fly apart and meet again: the number of components changes from frame to frame.
TEST_F(Allocations, NoneWithComponents) {
  const Context context;
  Atoms atoms = crambin();
  for (int k = 0; k < 40; ++k) atoms.add(30 + 3 * k, 0, 0, 1.5);
  set_atoms(context, atoms);
  qses_settings s = settings(0.5, 1.4, QSES_SURFACE_VDW);
  s.components = 1;
  uint32_t fewest = ~0u, most = 0;
  expect_no_allocation(atoms, [&](const std::vector<float> &positions) {
    set_positions(context, positions);
    const uint32_t count = begin_and_collect(context, s).component_count;
    fewest = std::min(fewest, count);
    most = std::max(most, count);
  });
  EXPECT_LT(fewest, most);
}

TEST_F(Allocations, NoneWhereSeriesTakeTurns) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  qses_settings s = settings();
  s.frame_budget_ms = 0.001f;  // none fits: always the coarsest
  expect_no_allocation(
      atoms,
      [&](const std::vector<float> &positions) {
        ++s.series;
        set_positions(context, positions);
        begin_and_collect(context, s);
      },
      QSES_REMEMBERED_SERIES + 100);
}

TEST_F(Allocations, NoneWithAMemoryBudget) {
  const Context context(2, uint64_t(16) << 20);
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  expect_no_allocation(atoms, [&](const std::vector<float> &positions) {
    set_positions(context, positions);
    begin_and_collect(context, settings());
  });
}

TEST_F(Allocations, NoneWithAFrameBudget) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  qses_settings s = settings();
  s.frame_budget_ms = 0.001f;  // none fits: always the coarsest
  expect_no_allocation(atoms, [&](const std::vector<float> &positions) {
    set_positions(context, positions);
    begin_and_collect(context, s);
  });
}

// So many atoms that sorting and scanning are done in parallel.
TEST_F(Allocations, NoneWithManyAtoms) {
  const Context context;
  Atoms atoms;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> off(-0.5, 0.5);
  for (int k = 0; k < 35000; ++k)
    atoms.add(2 * (k % 33) + off(random), 2 * (k / 33 % 33) + off(random), 2 * (k / 33 / 33) + off(random), 1.5);
  set_atoms(context, atoms);
  qses_settings s = settings(2.0);
  s.level_count = 0;
  expect_no_allocation(
      atoms,
      [&](const std::vector<float> &positions) {
        set_positions(context, positions);
        begin_and_collect(context, s);
      },
      8);
}

// Meshes that are shown while the next ones are made, as a viewer keeps them: one that is shown, one that arrives.
TEST_F(Allocations, NoneInAThousandFramesThatAreKept) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  qses_kept_mesh *kept[2] = {};
  for (qses_kept_mesh *&one : kept) expect_ok(qses_kept_mesh_create(&one));
  qses_settings s = settings(1.0);
  s.components = s.pickable = 1;
  s.level_count = 1;
  std::vector<uint32_t> values(atoms.size(), 1), painted;
  int frame = 0;
  uint64_t vertices = 0;
  expect_no_allocation(
      atoms,
      [&](const std::vector<float> &positions) {
        set_positions(context, positions);
        const uint32_t count = begin_and_collect(context, s).vertex_count;
        qses_kept_mesh *const next = kept[frame++ % 2];
        expect_ok(qses_keep(context, next));
        if (painted.empty()) painted.resize(2 * count);
        expect_ok(qses_kept_mesh_paint(next, values.data(), 4, atoms.size(), 0, count, painted.data()));
        const float origin[3] = {-100, 10, 6}, direction[3] = {1, 0, 0};
        qses_hit hit;
        qses_hit_init(&hit);
        expect_ok(qses_kept_mesh_pick(next, origin, direction, nullptr, 0, &hit));
        vertices += hit.found ? count : 0;
        if (frame % 10 == 0) qses_kept_mesh_clear(next);
      },
      1000);
  for (qses_kept_mesh *one : kept) qses_kept_mesh_destroy(one);
  EXPECT_GT(vertices, 0u);
}

TEST_F(Allocations, NoneOnOneThread) {
  const Context context(1);
  const Atoms atoms = cluster(1000, 3);
  set_atoms(context, atoms);
  expect_no_allocation(atoms, [&](const std::vector<float> &positions) {
    set_positions(context, positions);
    begin_and_collect(context, settings(0.7));
  });
}

}  // namespace
