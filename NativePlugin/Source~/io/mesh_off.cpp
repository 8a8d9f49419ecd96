// SPDX-License-Identifier: MIT
// Meshes as Geomview's OFF. Colours are from 0 to 255, as MeshLab and CGAL read them; Geomview itself has 0 to 1.
#include "io/mesh_formats.h"
#include "io/mesh_rows.h"

namespace quickses::io {

void write_off(AtomicFile &file, const MeshView &mesh) {
  file.write(std::string(mesh.colors ? "COFF" : "OFF") + "\n# QuickSES molecular surface, lengths in " + mesh.unit +
             "\n" + std::to_string(place_count(mesh)) + " " + std::to_string(mesh.triangle_count) + " 0\n");
  const auto put = [](char *out, auto value) {
    out = put_text(out, value);
    *out++ = ' ';
    return out;
  };
  put_rows(file, place_count(mesh), 7 * kMaxNumber, [&](char *out, size_t i) {
    for (int axis = 0; axis < 3; ++axis) out = put(out, mesh.positions[3 * i + axis]);
    if (mesh.colors)
      for (int channel = 0; channel < 4; ++channel) out = put(out, uint32_t{mesh.colors[4 * i + channel]});
    out[-1] = '\n';
    return out;
  });
  put_rows(file, mesh.triangle_count, 4 * kMaxNumber, [&](char *out, size_t t) {
    out = put(out, uint32_t{3});
    for (int corner = 0; corner < 3; ++corner) out = put(out, place_of(mesh, mesh.indices[3 * t + corner]));
    out[-1] = '\n';
    return out;
  });
}

}  // namespace quickses::io
