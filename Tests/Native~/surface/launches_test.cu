// SPDX-License-Identifier: MIT
// No launch is given more than the smallest GPU does in a short time (parallel/cuda_launch.cuh), whatever the atoms;
// and meshes don't depend on how the work is cut. With QUICKSES_MEASURE_LAUNCHES=1, or with names of files of x, y, z
// and radius, separated by colons, it prints how long the launches of a warm surface take here.
#include "surface/surface_fixture.h"

#include "parallel/cuda_launch.cuh"
#include "parallel/cuda_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

using namespace surface_fixture;

namespace {

#define REQUIRE_DEVICE() \
  if (!quickses::describe_cuda_device(0).available) GTEST_SKIP() << "no CUDA device"

// For some 40 microseconds.
__global__ void keep_busy() {
  const long long begin = clock64();
  while (clock64() - begin < 70000) {
  }
}

class LaunchBook : public quickses::LaunchObserver {
 public:
  // Of a GPU with so many multiprocessors; 0: as many as there are.
  explicit LaunchBook(unsigned multiprocessors = 0, bool is_timed = false)
      : multiprocessors_(multiprocessors), is_timed_(is_timed) {
    current = this;
  }
  ~LaunchBook() override {
    current = nullptr;
    for (cudaEvent_t event : events_)
      if (event) cudaEventDestroy(event);
  }
  unsigned multiprocessors(unsigned there_are) override { return multiprocessors_ ? multiprocessors_ : there_are; }
  void before(const Launch &launch) override {
    Entry &entry = entries[launch.name];
    ++entry.launches;
    ++launches;
    entry.steps = std::max(entry.steps, launch.steps);
    if (!is_timed_) return;
    keep_busy<<<1, 1, 0, launch.stream>>>();  // so that the GPU need not wait for the CPU between the marks
    mark(0, launch.stream);
  }
  void after(const Launch &launch) override {
    if (!is_timed_) return;
    mark(1, launch.stream);
    quickses::check_cuda(cudaEventSynchronize(events_[1]), "cudaEventSynchronize");
    float ms = 0;
    quickses::check_cuda(cudaEventElapsedTime(&ms, events_[0], events_[1]), "cudaEventElapsedTime");
    Entry &entry = entries[launch.name];
    entry.longest_ms = std::max(entry.longest_ms, ms);
    entry.all_ms += ms;
  }

  void forget() {
    entries.clear();
    launches = 0;
  }

  struct Entry {
    size_t launches = 0;
    uint64_t steps = 0;  // per multiprocessor, of the launch that has most
    float longest_ms = 0, all_ms = 0;
  };
  std::map<std::string, Entry> entries;
  size_t launches = 0;

 private:
  void mark(int which, cudaStream_t stream) {
    if (!events_[which]) quickses::check_cuda(cudaEventCreate(&events_[which]), "cudaEventCreate");
    quickses::check_cuda(cudaEventRecord(events_[which], stream), "cudaEventRecord");
  }
  unsigned multiprocessors_;
  bool is_timed_;
  cudaEvent_t events_[2] = {};
};

struct Input {
  std::string name;
  Atoms atoms;
  qses_settings settings;
};

Atoms in_a_box(size_t count, double edge, double radius) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0, edge);
  Atoms atoms;
  for (size_t k = 0; k < count; ++k) atoms.add(place(random), place(random), place(random), radius);
  return atoms;
}
Atoms of_all_sizes(size_t count) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(0, 1);
  Atoms atoms;
  for (size_t k = 0; k < count; ++k)
    atoms.add(150 * unit(random), 150 * unit(random), 150 * unit(random), std::pow(10.0, 3 * unit(random) - 1));
  return atoms;
}
Atoms on_a_line(size_t count) {
  Atoms atoms;
  for (size_t k = 0; k < count; ++k) atoms.add(0.05 * double(k), 0, 0, 1.5);
  return atoms;
}
Atoms giant_with(size_t count) {
  Atoms atoms;
  atoms.add(0, 0, 0, 60);
  for (size_t k = 0; k < count; ++k) {  // a spiral from pole to pole
    const double z = 1 - (2.0 * double(k) + 1) / double(count), r = std::sqrt(1 - z * z), a = 2.399963 * double(k);
    atoms.add(61 * r * std::cos(a), 61 * r * std::sin(a), 61 * z, 1);
  }
  return atoms;
}
// Two spheres whose circle is cut into very many pieces.
Atoms beads_on_a_circle(size_t count) {
  Atoms atoms;
  atoms.add(-30, 0, 0, 50).add(30, 0, 0, 50);
  for (size_t k = 0; k < count; ++k) {
    const double a = 2 * 3.14159265358979 * double(k) / double(count), r = std::sqrt(50.1 * 50.1 - 900);
    atoms.add(0, r * std::cos(a), r * std::sin(a), 0.05);
  }
  return atoms;
}
Atoms twice(const Atoms &once) {
  Atoms atoms = once;
  for (size_t k = 0; k < once.size(); ++k) {
    const auto c = once.center(k);
    atoms.add(c[0], c[1], c[2], double(once.radii[k]));
  }
  return atoms;
}

qses_settings voxels(qses_settings s) {
  s.method = QSES_METHOD_GRID;
  return s;
}

std::vector<Input> crowded_inputs() {
  return {
      {"crambin", crambin(), settings()},
      {"crambin twice", twice(crambin()), settings()},
      {"2,500 atoms within 1.5 A", in_a_box(2500, 1.5, 1.7), settings()},
      {"2,500 atoms within 1.5 A, voxels", in_a_box(2500, 1.5, 1.7), voxels(settings())},
      {"4,000 atoms within 0.01 A", in_a_box(4000, 0.01, 1.7), settings()},
      {"radii of 0.1 to 100 A", of_all_sizes(400), settings(2)},
      {"radii of 0.1 to 100 A, voxels", of_all_sizes(400), voxels(settings(2, 20))},
      {"two atoms at a large p / h, voxels", Atoms().add(0, 0, 0, 1.7).add(2, 0, 0, 1.6), voxels(settings(0.05, 10))},
      {"3,000 atoms on a line", on_a_line(3000), settings()},
      {"a giant and 3,000 small ones", giant_with(3000), settings(2)},
      {"a giant and 3,000 small ones, edges wider than two probes", giant_with(3000), settings(4)},
      {"crambin, edges wider than two probes", crambin(), settings(4)},
      {"lattice", lattice(5, 3.95, 1.7), settings()},
      {"lattice of probes", lattice(5, 4, 1.9), settings(0.5, 1.4, QSES_SURFACE_SAS)},
      {"a giant at a fine spacing", giant_with(0), settings(0.2)},
      {"800 beads on a circle", beads_on_a_circle(800), settings(2, 0.1)}};
}

void expect_same(const Surface &a, const Surface &b, const std::string &name) {
  EXPECT_EQ(a.mesh.indices, b.mesh.indices) << name;
  EXPECT_EQ(a.mesh.owners, b.mesh.owners) << name;
  ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size()) << name;
  EXPECT_EQ(std::memcmp(a.mesh.positions.data(), b.mesh.positions.data(), 4 * a.mesh.positions.size()), 0) << name;
  EXPECT_EQ(std::memcmp(a.mesh.normals.data(), b.mesh.normals.data(), 4 * a.mesh.normals.size()), 0) << name;
}

// Meshes on this GPU, and with launches as for one with a single multiprocessor, or with very many, for which
// everything is few.
TEST(Launches, AreBoundedAndMeshesDoNotDependOnThem) {
  REQUIRE_DEVICE();
  for (const Input &input : crowded_inputs()) {
    std::map<unsigned, Surface> surfaces;
    std::map<unsigned, size_t> launches;
    for (const unsigned multiprocessors : {0u, 1u, 5000u}) {
      LaunchBook book(multiprocessors);
      const Context context(0, 0, QSES_BACKEND_CUDA);
      surfaces[multiprocessors] = compute(context, input.atoms, input.settings);
      launches[multiprocessors] = book.launches;
      for (const auto &entry : book.entries)
        EXPECT_LE(entry.second.steps, quickses::kLaunchSteps) << input.name << ", " << entry.first;
    }
    EXPECT_GT(launches[0], 10u);
    EXPECT_GE(launches[1], launches[0]);
    EXPECT_EQ(mesh_checks::manifold_fault(surfaces[0].mesh), "") << input.name;
    EXPECT_GT(surfaces[0].vertex_count(), 100u) << input.name;
    expect_same(surfaces[0], surfaces[1], input.name);
    expect_same(surfaces[0], surfaces[5000], input.name);
  }
}

// With little memory there are other ways to the same mesh.
TEST(Launches, AreBoundedWithLittleMemory) {
  REQUIRE_DEVICE();
  for (const Input &input : {Input{"crambin", crambin(), settings(0.3)},
                             Input{"1,500 atoms within 1.5 A", in_a_box(1500, 1.5, 1.7), settings(0.3)}}) {
    Surface whole;
    {
      const Context context(0, 0, QSES_BACKEND_CUDA);
      whole = compute(context, input.atoms, input.settings);
    }
    LaunchBook book(1);
    const Context context(0, whole.report.work_bytes_peak / 2, QSES_BACKEND_CUDA);
    expect_same(whole, compute(context, input.atoms, input.settings), input.name);
    for (const auto &entry : book.entries)
      EXPECT_LE(entry.second.steps, quickses::kLaunchSteps) << input.name << ", " << entry.first;
  }
}

Atoms read_atoms(const std::string &path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("can't open " + path);
  Atoms atoms;
  for (double x, y, z, r; file >> x >> y >> z >> r;) atoms.add(x, y, z, r);
  return atoms;
}

TEST(Launches, Measured) {
  REQUIRE_DEVICE();
  const char *const wanted = std::getenv("QUICKSES_MEASURE_LAUNCHES");
  if (!wanted) GTEST_SKIP() << "QUICKSES_MEASURE_LAUNCHES is not set";
  std::vector<Input> inputs;
  if (std::string(wanted) == "1") inputs = crowded_inputs();
  std::istringstream files(wanted);
  for (std::string path; inputs.empty() || std::string(wanted) != "1";) {
    if (!std::getline(files, path, ':')) break;
    inputs.push_back({path, read_atoms(path), settings()});
  }
  const char *const spacing = std::getenv("QUICKSES_MEASURE_SPACING");                  // A
  const char *const multiprocessors = std::getenv("QUICKSES_MEASURE_MULTIPROCESSORS");  // as if there were so many
  for (Input &input : inputs) {
    if (spacing) input.settings.spacing = float(std::atof(spacing));
    LaunchBook book(multiprocessors ? static_cast<unsigned>(std::atoi(multiprocessors)) : 0, true);
    const Context context(0, 0, QSES_BACKEND_CUDA);
    compute(context, input.atoms, input.settings);
    book.forget();  // the next one is warm
    compute(context, input.atoms, input.settings);
    std::vector<std::pair<std::string, LaunchBook::Entry>> sorted(book.entries.begin(), book.entries.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const auto &a, const auto &b) { return a.second.all_ms > b.second.all_ms; });
    std::printf("%s: %zu launches\n", input.name.c_str(), book.launches);
    for (const auto &[name, entry] : sorted)
      std::printf("  %-40s %6zu launches, all %9.4f ms, longest %8.4f ms, of at most %.4f of the steps\n", name.c_str(),
                  entry.launches, double(entry.all_ms), double(entry.longest_ms),
                  double(entry.steps) / double(quickses::kLaunchSteps));
  }
}

}  // namespace
