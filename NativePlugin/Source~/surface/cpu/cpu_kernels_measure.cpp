// SPDX-License-Identifier: MIT
// CPU kernel: area and volume of triangles, four at a time.
#include "parallel/double_pack.h"
#include "surface/cpu/cpu_kernels.h"

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

struct CornersOfFour {
  const MeshView &mesh;
  uint32_t vertices[3][kDoublePackSize];
  QSES_FN Vec3<DoublePack> position(int k) const {
    return load([&](int lane) { return mesh.position(vertices[k][lane]); });
  }
  QSES_FN Vec3<DoublePack> normal(int k) const {
    return load([&](int lane) { return mesh.normal(vertices[k][lane]); });
  }
  QSES_FN Vec3<DoublePack> second_normal(int k) const {
    return load([&](int lane) { return mesh.second_normal(vertices[k][lane]); });
  }

 private:
  template <class Place>
  QSES_FN static Vec3<DoublePack> load(const Place &place) {
    Vec3<DoublePack> v;
    load_triples(place, &v.x, &v.y, &v.z);
    return v;
  }
};

}  // namespace

void measure_triangles(const MeasureTriangle &measure, size_t first, size_t count, TriangleSums *sums) {
  const MeshView &mesh = measure.mesh;
  const Vec3<DoublePack> origin(measure.origin.x, measure.origin.y, measure.origin.z);
  constexpr size_t kFour = kDoublePackSize;
  for (size_t t = 0; t < count; t += kFour) {
    const size_t n = count - t < kFour ? count - t : kFour;
    CornersOfFour corners{mesh, {}};
    for (size_t lane = 0; lane < kFour; ++lane) {
      const Corners own = outward_corners(mesh, mesh.triangle(first + t + (lane < n ? lane : n - 1)));
      for (int k = 0; k < 3; ++k) corners.vertices[k][lane] = own.v[k];
    }
    const SumsOfTriangles<DoublePack> four =
        measure_corners(corners, origin, measure.bent, mesh.second_normals != nullptr);
    double area[kFour], volume[kFour], flat_area[kFour], flat_volume[kFour];
    store_pack(area, four.area);
    store_pack(volume, four.volume);
    store_pack(flat_area, four.flat_area);
    store_pack(flat_volume, four.flat_volume);
    for (size_t lane = 0; lane < n; ++lane)
      sums[t + lane] = {area[lane], volume[lane], flat_area[lane], flat_volume[lane]};
  }
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
