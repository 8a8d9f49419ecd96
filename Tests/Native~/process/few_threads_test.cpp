// SPDX-License-Identifier: MIT
// A machine that refuses threads or memory, and callers with little stack: this program has functions of the C library
// of its own, which refuse what they are told to.
#include "io/own_folder.h"
#include "process/later_release.h"
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <dlfcn.h>
#include <pthread.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <iterator>
#include <thread>

using namespace surface_fixture;

namespace {

std::atomic<int> allowed{1 << 20};  // threads that may still be started
std::atomic<bool> files_find_no_memory{false};

}  // namespace

extern "C" int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*routine)(void *), void *x) {
  using Create = int (*)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
  static const Create create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (allowed.fetch_sub(1) <= 0) return EAGAIN;
  return create(thread, attributes, routine, x);
}

extern "C" std::FILE *fopen(const char *path, const char *mode) {
  using Open = std::FILE *(*)(const char *, const char *);
  static const Open open = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "fopen"));
  if (!files_find_no_memory) return open(path, mode);
  errno = ENOMEM;
  return nullptr;
}

namespace {

class Allow {
 public:
  explicit Allow(int threads) { allowed = threads; }
  ~Allow() { allowed = 1 << 20; }
};

Surface surface_of(qses_context *context, const Atoms &atoms, const qses_settings &s) {
  set_atoms(context, atoms);
  expect_ok(qses_compute(context, &s, nullptr));
  return copy_surface(context);
}

void expect_same(const Surface &a, const Surface &b) {
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.indices, b.mesh.indices);
  EXPECT_EQ(a.report.area, b.report.area);
}

TEST(FewThreads, ComputeMakesDoWithTheCallers) {
  const Atoms atoms = cluster(2000, 3);
  Surface alone;
  {
    const Allow none(0);
    const Context context(8);
    alone = surface_of(context, atoms, settings());
    EXPECT_EQ(mesh_checks::manifold_fault(alone.mesh), "");
    qses_size_estimate estimate;
    qses_size_estimate_init(&estimate);
    expect_ok(qses_estimate(context, nullptr, &estimate));
    const qses_settings s = settings();
    EXPECT_EQ(qses_begin(context, &s), QSES_OUT_OF_MEMORY);
    EXPECT_NE(std::string(qses_last_error()).find("thread"), std::string::npos);
    expect_same(surface_of(context, atoms, settings()), alone);
  }
  expect_same(compute(atoms, settings(), 8), alone);
}

TEST(FewThreads, AnyNumberOfThemThatCanBeHad) {
  const Atoms atoms = cluster(2000, 3);
  const Surface usual = compute(atoms, settings(), 1);
  for (int threads : {1, 2, 3, 5}) {
    SCOPED_TRACE(threads);
    const Allow some(threads);
    const Context context(8);
    expect_same(surface_of(context, atoms, settings()), usual);
  }
}

// Without a thread that could do it, whoever hands it over releases it: once, also if there are threads again.
TEST(FewThreads, MemoryIsReleasedWithoutOne) {
  struct Item {
    std::atomic<int> releases{0};
    std::atomic<std::thread::id> thread{};
  };
  static Item items[100], later;
  const auto release = [](void *memory) {
    static_cast<Item *>(memory)->thread = std::this_thread::get_id();
    ++static_cast<Item *>(memory)->releases;
  };
  const auto wait_for = [](const Item &item) {
    while (item.releases == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  Item *item = items;
  for (;; ++item) {  // there may be a thread from before
    ASSERT_NE(item, std::end(items));
    const Allow none(0);
    quickses::release_later(release, item);
    wait_for(*item);
    if (item->thread.load() == std::this_thread::get_id()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  quickses::release_later(release, &later);
  wait_for(later);
  EXPECT_EQ(item->releases, 1);
  EXPECT_EQ(later.releases, 1);
}

// ---- no memory

TEST(LittleMemory, FilesThatFindNoneAreNotToBlame) {
  const std::string path = std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb";
  qses_structure *structure = nullptr;
  qses_trajectory *trajectory = nullptr;
  files_find_no_memory = true;
  const qses_status opened = qses_structure_open(path.c_str(), nullptr, &structure),
                    opened_frames = qses_trajectory_open(path.c_str(), QSES_TRAJECTORY_PDB, &trajectory);
  files_find_no_memory = false;
  EXPECT_EQ(opened, QSES_OUT_OF_MEMORY);
  EXPECT_EQ(opened_frames, QSES_OUT_OF_MEMORY);
}

// ---- little stack

// Runs call() on a thread with so much stack and a guard behind.
void on_small_stack(const std::function<void()> &call, size_t bytes = size_t(64) << 10) {
  pthread_attr_t attributes;
  ASSERT_EQ(pthread_attr_init(&attributes), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, bytes), 0);
  pthread_t thread;
  const int started = pthread_create(
      &thread, &attributes,
      [](void *f) -> void * {
        (*static_cast<const std::function<void()> *>(f))();
        return nullptr;
      },
      const_cast<std::function<void()> *>(&call));
  pthread_attr_destroy(&attributes);
  ASSERT_EQ(started, 0);
  pthread_join(thread, nullptr);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SKIP_IF_STACKS_ARE_LARGER() GTEST_SKIP() << "sanitizers make frames larger"
#else
#define SKIP_IF_STACKS_ARE_LARGER()
#endif

TEST(SmallStack, SufficesForAllSurfaces) {
  SKIP_IF_STACKS_ARE_LARGER();
  const Atoms atoms = cluster(3000, 3);
  for (unsigned threads : {1u, 2u, 4u})
    for (int kind = 0; kind < 6; ++kind) {
      SCOPED_TRACE(testing::Message() << "kind " << kind << ", " << threads << " threads");
      qses_settings s = settings(0.6, kind == 4 ? 6.0 : 1.4, static_cast<qses_surface>(kind < 3 ? kind : 0));
      s.relaxation_steps = 3;
      s.components = 1;
      if (kind == 3) s.method = QSES_METHOD_GRID;
      if (kind == 5) s.slice_size = 32;
      qses_status status = QSES_OK, estimated = QSES_OK, begun = QSES_OK, visible = QSES_OK;
      std::vector<uint8_t> shown(atoms.size(), 1);
      for (size_t i = 0; i < shown.size(); i += 3) shown[i] = 0;
      on_small_stack([&] {
        const Context context(threads, kind == 5 ? uint64_t(64) << 20 : 0);
        set_atoms(context, atoms);
        qses_size_estimate estimate;
        qses_size_estimate_init(&estimate);
        estimated = qses_estimate(context, &s, &estimate);
        status = qses_compute(context, &s, nullptr);
        visible = qses_set_visible(context, shown.data(), shown.size());
        begun = qses_begin(context, &s);
        qses_wait(context, -1, nullptr);
      });
      EXPECT_EQ(status, QSES_OK);
      EXPECT_EQ(estimated, QSES_OK);
      EXPECT_EQ(visible, QSES_OK);
      EXPECT_EQ(begun, QSES_OK);
    }
}

TEST(SmallStack, SufficesForSortingManyAtoms) {
  SKIP_IF_STACKS_ARE_LARGER();
  Atoms atoms;
  for (int k = 0; k < 70000; ++k) atoms.add(3 * (k % 42), 3 * (k / 42 % 42), 3 * (k / 42 / 42), 1.5);
  for (unsigned threads : {1u, 2u}) {
    qses_status status = QSES_INTERNAL_ERROR;
    const qses_settings s = settings(3.0);
    on_small_stack([&] {
      const Context context(threads);
      set_atoms(context, atoms);
      status = qses_compute(context, &s, nullptr);
    });
    EXPECT_EQ(status, QSES_OK);
  }
}

std::string read_file(const std::string &path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string packed(const std::string &text) {
  z_stream stream = {};
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef *>(const_cast<char *>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef *>(&out[0]);
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string cif() {
  std::string text =
      "data_small\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
      "_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n"
      "_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  for (int k = 1; k <= 20000; ++k)
    text += "ATOM " + std::to_string(k) + " C CA ALA A " + std::to_string(k) + " " + std::to_string(k) + ".5 2.0 3.0\n";
  return text;
}

TEST(SmallStack, SufficesForStructuresAndTrajectories) {
  SKIP_IF_STACKS_ARE_LARGER();
  const std::string pdb = read_file(std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb");
  std::string many_models;
  for (int model = 1; model <= 30; ++model) {
    std::istringstream lines(pdb);
    many_models += "MODEL     " + std::to_string(1000 + model) + "\n";
    for (std::string line; std::getline(lines, line);)
      if (line.compare(0, 4, "ATOM") == 0) many_models += line + "\n";
    many_models += "ENDMDL\n";
  }
  const OwnFolder folder;
  struct File {
    const char *name;
    std::string bytes;
  };
  for (const File &file :
       {File{"a.pdb.gz", packed(pdb)}, File{"a.cif.gz", packed(cif())}, File{"a.cif", cif()}, File{"a.pdb", pdb}}) {
    SCOPED_TRACE(file.name);
    const std::string path = folder.path(file.name);
    std::ofstream(path, std::ios::binary) << file.bytes;
    qses_status from_file = QSES_INTERNAL_ERROR, from_memory = QSES_INTERNAL_ERROR;
    on_small_stack([&] {
      qses_structure_options options;
      qses_structure_options_init(&options);
      options.selection = "//A";
      qses_structure *structure = nullptr;
      from_file = qses_structure_open(path.c_str(), &options, &structure);
      qses_structure_close(structure);
      from_memory = qses_structure_open_memory(file.bytes.data(), file.bytes.size(), &options, &structure);
      qses_structure_close(structure);
    });
    EXPECT_EQ(from_file, QSES_OK);
    EXPECT_EQ(from_memory, QSES_OK);
  }
  const std::string trajectory_bytes = packed(many_models);
  qses_status opened = QSES_INTERNAL_ERROR, read = QSES_INTERNAL_ERROR;
  on_small_stack([&] {
    qses_trajectory *trajectory = nullptr;
    opened =
        qses_trajectory_open_memory(trajectory_bytes.data(), trajectory_bytes.size(), QSES_TRAJECTORY_PDB, &trajectory);
    std::vector<float> positions(3 * 327);
    read = qses_trajectory_read_frame(trajectory, 29, positions.data(), 0, 327, nullptr);
    qses_trajectory_close(trajectory);
  });
  EXPECT_EQ(opened, QSES_OK);
  EXPECT_EQ(read, QSES_OK);
}

std::string nested(int depth, const std::string &begin, const std::string &end) {
  std::string text = "all";
  for (int k = 0; k < depth; ++k) text = begin + text + end;
  return text;
}

TEST(SmallStack, SufficesForTheDeepestSelections) {
  SKIP_IF_STACKS_ARE_LARGER();
  const std::string path = std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb";
  qses_structure_options options;
  qses_structure_options_init(&options);
  qses_structure *structure = nullptr;
  expect_ok(qses_structure_open(path.c_str(), &options, &structure));
  std::vector<uint8_t> mask(327);
  const std::pair<const char *, const char *> kinds[] = {
      {"(", ")"}, {"not ", ""}, {"not (", ")"}, {"(none or all and ", ")"}, {"same residue as (none or all and ", ")"}};
  for (const auto &[begin, end] : kinds) {
    SCOPED_TRACE(begin);
    const auto select = [&](int depth) {
      return qses_structure_select(structure, nested(depth, begin, end).c_str(), mask.data(), mask.size(), nullptr);
    };
    int deepest = 20;
    while (select(deepest + 1) == QSES_OK) ++deepest;
    EXPECT_NE(std::string(qses_last_error()).find("in each other"), std::string::npos);
    qses_status selected = QSES_INTERNAL_ERROR, refused = QSES_INTERNAL_ERROR, opened = QSES_INTERNAL_ERROR;
    on_small_stack(
        [&] {
          refused = select(deepest + 1);
          selected = select(deepest);
        },
        size_t(32) << 10);  // half of what there is, since others build with larger frames
    const std::string text = nested(deepest, begin, end);
    options.selection = text.c_str();
    on_small_stack([&] {
      qses_structure *selecting = nullptr;
      opened = qses_structure_open(path.c_str(), &options, &selecting);
      qses_structure_close(selecting);
    });
    EXPECT_EQ(selected, QSES_OK);
    EXPECT_EQ(refused, QSES_INVALID_ARGUMENT);
    const bool selects_some = std::count(mask.begin(), mask.end(), 0) < static_cast<ptrdiff_t>(mask.size());
    EXPECT_EQ(opened == QSES_OK, selects_some) << opened;
  }
  qses_structure_close(structure);
}

}  // namespace
