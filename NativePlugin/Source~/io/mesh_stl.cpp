// SPDX-License-Identifier: MIT
// Meshes as binary STL.
#include <algorithm>
#include <cmath>

#include "io/mesh_formats.h"
#include "io/mesh_rows.h"

namespace quickses::io {

void write_stl(AtomicFile &file, const MeshView &mesh) {
  constexpr size_t kTextSize = 80;
  char header[kTextSize + 4] = {};
  const std::string text = "QuickSES molecular surface, binary STL, lengths in " + mesh.unit;
  std::copy_n(text.data(), std::min(text.size(), kTextSize), header);
  put_binary(header + kTextSize, mesh.triangle_count);
  file.write(header, sizeof header);
  put_rows(file, mesh.triangle_count, 50, [&](char *out, size_t t) {
    const float *corners[3];
    for (int corner = 0; corner < 3; ++corner)
      corners[corner] = mesh.positions + 3 * size_t(mesh.indices[3 * t + corner]);
    double u[3], v[3];
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] = double(corners[1][axis]) - corners[0][axis];
      v[axis] = double(corners[2][axis]) - corners[0][axis];
    }
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const double scale = length > 0 ? 1 / length : 0;
    for (double component : n) out = put_binary(out, static_cast<float>(component * scale));
    for (const float *corner : corners) out = put_binary(out, corner);
    *out++ = 0;
    *out++ = 0;
    return out;
  });
}

}  // namespace quickses::io
