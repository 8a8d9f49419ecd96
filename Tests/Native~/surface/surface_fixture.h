// SPDX-License-Identifier: MIT
// Atoms for tests, and surfaces of them by the C API. Lengths in Å.
#pragma once

#include "surface/mesh_checks.h"

#include "quickses/quickses.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace surface_fixture {

struct Atoms {
  std::vector<float> positions;  // N x 3
  std::vector<float> radii;

  size_t size() const { return radii.size(); }
  Atoms &add(double x, double y, double z, double r) {
    for (double p : {x, y, z}) positions.push_back(static_cast<float>(p));
    radii.push_back(static_cast<float>(r));
    return *this;
  }
  std::array<double, 3> center(size_t i) const {
    return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
  }
};

// Rotated by a fixed rotation that favours no axis, then shifted.
inline Atoms turned(const Atoms &atoms, double dx = 0, double dy = 0, double dz = 0) {
  const double w = 0.7, x = 0.31, y = -0.52, z = 0.38, n = 1 / std::sqrt(w * w + x * x + y * y + z * z);
  const double a = w * n, b = x * n, c = y * n, d = z * n;
  const double m[3][3] = {{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                          {2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)},
                          {2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d}};
  Atoms out;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const auto p = atoms.center(i);
    double q[3];
    for (int k = 0; k < 3; ++k) q[k] = m[k][0] * p[0] + m[k][1] * p[1] + m[k][2] * p[2];
    out.add(q[0] + dx, q[1] + dy, q[2] + dz, static_cast<double>(atoms.radii[i]));
  }
  return out;
}

inline Atoms shifted(const Atoms &atoms, double dx, double dy, double dz) {
  Atoms out;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const auto p = atoms.center(i);
    out.add(p[0] + dx, p[1] + dy, p[2] + dz, static_cast<double>(atoms.radii[i]));
  }
  return out;
}

// Those of both.
inline Atoms with(Atoms a, const Atoms &b) {
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.radii.insert(a.radii.end(), b.radii.begin(), b.radii.end());
  return a;
}

// Apart by so much more; the radii are the same.
inline Atoms scaled(const Atoms &atoms, double factor) {
  Atoms out;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const auto p = atoms.center(i);
    out.add(factor * p[0], factor * p[1], factor * p[2], static_cast<double>(atoms.radii[i]));
  }
  return out;
}

// A compact cluster whose atoms overlap about as much as those of a protein.
inline Atoms cluster(size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double extent = 1.35 * std::cbrt(static_cast<double>(count));
  const double radii[] = {1.2, 1.52, 1.55, 1.7, 1.8};
  Atoms atoms;
  for (size_t tries = 0; atoms.size() < count && tries < 400 * count; ++tries) {
    const double x = extent * unit(random), y = extent * unit(random), z = extent * unit(random);
    bool free = x * x + y * y + z * z < extent * extent;
    for (size_t i = 0; i < atoms.size() && free; ++i) {
      const auto c = atoms.center(i);
      free = std::hypot(c[0] - x, c[1] - y, c[2] - z) > 1.25;
    }
    if (free) atoms.add(x, y, z, radii[random() % 5]);
  }
  return atoms;
}

// Balls whose centres are those of a regular polygon.
inline Atoms ring(size_t count, double radius, double r) {
  Atoms atoms;
  for (size_t k = 0; k < count; ++k) {
    const double a = 2 * std::acos(-1.0) * static_cast<double>(k) / static_cast<double>(count);
    atoms.add(radius * std::cos(a), radius * std::sin(a), 0, r);
  }
  return atoms;
}
// n x n x n balls, of which many meet in a point.
inline Atoms lattice(int n, double edge, double r) {
  Atoms atoms;
  for (int k = 0; k < n * n * n; ++k) atoms.add(edge * (k % n), edge * (k / n % n), edge * (k / n / n), r);
  return atoms;
}

// Random atoms with so much room for each, as sparse as no molecule is from some 60 Å³ on.
inline Atoms sparse(size_t count, double volume, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0.0, std::cbrt(static_cast<double>(count) * volume));
  const double radii[] = {1.52, 1.7, 1.8};
  Atoms atoms;
  for (size_t k = 0; k < count; ++k) {
    const double x = place(random), y = place(random), z = place(random);
    atoms.add(x, y, z, radii[random() % 3]);
  }
  return atoms;
}

// The ATOM records of a PDB file, or those of this name.
inline Atoms read_pdb(const std::string &path, const std::string &name = "") {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("can't open " + path);
  Atoms atoms;
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, 4, "ATOM") != 0 || (!name.empty() && line.compare(12, 4, name) != 0)) continue;
    const char element = line.at(13);
    atoms.add(std::stod(line.substr(30, 8)), std::stod(line.substr(38, 8)), std::stod(line.substr(46, 8)),
              element == 'O'   ? 1.52
              : element == 'N' ? 1.55
              : element == 'C' ? 1.7
                               : 1.8);
  }
  return atoms;
}

inline Atoms crambin() { return read_pdb(std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb"); }
inline Atoms alpha_carbons() { return read_pdb(std::string(QUICKSES_TEST_DATA_DIR) + "/1CRN.pdb", " CA "); }

inline qses_settings settings(double spacing = 0.5, double probe = 1.4, qses_surface surface = QSES_SURFACE_SES) {
  qses_settings s;
  qses_settings_init(&s);
  s.spacing = static_cast<float>(spacing);
  s.probe_radius = static_cast<float>(probe);
  s.surface = surface;
  return s;
}

// The back end that tests of surfaces run on: the CPU, or CUDA if the environment has QUICKSES_TEST_BACKEND=cuda. Where
// there is no device then, the test program ends with 77, which CTest takes as skipped.
inline qses_backend tested_backend() {
  static const qses_backend backend = [] {
    const char *wanted = std::getenv("QUICKSES_TEST_BACKEND");
    if (!wanted || std::string(wanted) != "cuda") return QSES_BACKEND_CPU;
    qses_backend_description description;
    qses_backend_description_init(&description);
    if (qses_backend_info(QSES_BACKEND_CUDA, &description) != QSES_OK || !description.available) {
      std::printf("skipped: no CUDA device\n");
      std::exit(77);
    }
    return QSES_BACKEND_CUDA;
  }();
  return backend;
}

// A context that ends with the scope.
class Context {
 public:
  explicit Context(unsigned threads = 2, uint64_t memory_budget = 0, qses_backend backend = tested_backend()) {
    qses_context_options options;
    qses_context_options_init(&options);
    options.backend = backend;
    options.threads = threads;
    options.memory_budget = memory_budget;
    if (qses_context_create(&options, &context_) != QSES_OK) throw std::runtime_error(qses_last_error());
  }
  Context(const Context &) = delete;
  Context &operator=(const Context &) = delete;
  ~Context() { qses_context_destroy(context_); }
  operator qses_context *() const { return context_; }

 private:
  qses_context *context_ = nullptr;
};

struct Surface {
  mesh_checks::Mesh mesh;
  std::vector<uint8_t> patches;
  qses_report report;

  size_t vertex_count() const { return mesh.vertex_count(); }
  std::array<double, 3> normal(size_t v) const {
    return {mesh.normals[3 * v], mesh.normals[3 * v + 1], mesh.normals[3 * v + 2]};
  }
};

inline void expect_ok(qses_status status) {
  if (status != QSES_OK) throw std::runtime_error("status " + std::to_string(status) + ": " + qses_last_error());
}

// The mesh where the context keeps it.
inline qses_mesh compute_view(qses_context *context, const qses_settings &s) {
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  expect_ok(qses_compute(context, &s, &mesh));
  return mesh;
}

inline qses_size_estimate estimate_of(qses_context *context, const qses_settings &s) {
  qses_size_estimate estimate;
  qses_size_estimate_init(&estimate);
  expect_ok(qses_estimate(context, &s, &estimate));
  return estimate;
}

inline qses_report report_of(qses_context *context) {
  qses_report report;
  qses_report_init(&report);
  expect_ok(qses_context_report(context, &report));
  return report;
}

inline Surface copy_surface(qses_context *context) {
  qses_mesh m;
  qses_mesh_init(&m);
  expect_ok(qses_context_mesh(context, &m));
  Surface s;
  const size_t v = m.vertex_count, t = m.triangle_count;
  if (v > 0) {
    s.mesh.positions.assign(m.positions, m.positions + 3 * v);
    if (m.normals) s.mesh.normals.assign(m.normals, m.normals + 3 * v);
    s.mesh.owners.assign(m.owners, m.owners + v);
    s.mesh.indices.assign(m.indices, m.indices + 3 * t);
    if (m.patches) s.patches.assign(m.patches, m.patches + v);
  }
  s.report = report_of(context);
  return s;
}

inline void set_atoms(qses_context *context, const Atoms &atoms) {
  expect_ok(qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), atoms.size()));
}

inline Surface compute(qses_context *context, const Atoms &atoms, const qses_settings &s) {
  set_atoms(context, atoms);
  expect_ok(qses_compute(context, &s, nullptr));
  return copy_surface(context);
}

// The mesh a job ends with, as copy_surface gives it.
inline Surface finest_of_job(qses_context *context, const Atoms &atoms, const qses_settings &s) {
  set_atoms(context, atoms);
  expect_ok(qses_begin(context, &s));
  expect_ok(qses_wait(context, -1, nullptr));
  qses_mesh m;
  qses_mesh_init(&m);
  expect_ok(qses_collect(context, &m));
  return copy_surface(context);
}

inline Surface compute(const Atoms &atoms, const qses_settings &s, unsigned threads = 2) {
  const Context context(threads);
  return compute(context, atoms, s);
}

}  // namespace surface_fixture
