// SPDX-License-Identifier: MIT
// One copy brings a mesh from the GPU: it may read nothing but what the kernels write, each byte of it once.
#include "surface/mesh/mesh_arrays.h"

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace quickses;

TEST(MeshArrays, EveryByteBelongsToOneAttribute) {
  for (unsigned kind = 0; kind < 48; ++kind)
    for (const uint32_t vertices : {0u, 1u, 7u, 65u}) {
      MeshShape shape;
      shape.layout = static_cast<qses_vertex_layout>(kind / 16);
      shape.colors = (kind & 1) != 0;
      shape.texcoords = (kind & 2) != 0;
      shape.patches = (kind & 4) != 0;
      shape.component_ids = (kind & 8) != 0;
      const uint32_t triangles = 2 * vertices + 1;
      const MeshArrays arrays(vertices, triangles, shape);
      std::vector<uint32_t> memory(arrays.bytes() / 4 + 1);
      char *const begin = reinterpret_cast<char *>(memory.data());
      const MeshView view = arrays.view(begin);
      std::vector<int> written(arrays.bytes());
      const auto write = [&](const void *at, size_t bytes, size_t alignment) {
        const size_t first = static_cast<size_t>(static_cast<const char *>(at) - begin);
        ASSERT_EQ(first % alignment, 0u);
        ASSERT_LE(first + bytes, written.size());
        for (size_t k = 0; k < bytes; ++k) ++written[first + k];
      };
      for (uint32_t v = 0; v < vertices; ++v) {
        write(view.position(v), 12, 4);
        if (view.packed_normals)
          write(view.packed_normal(v), 4, 4);
        else
          write(view.normal(v), 12, 4);
        if (view.colors) write(view.color(v), 4, 4);
        if (view.texcoords) write(view.texcoord(v), 8, 4);
        write(&view.owner(v), 4, 4);
        if (view.component_ids) write(&view.component_id(v), 4, 4);
        if (view.patches) write(&view.patch(v), 1, 1);
      }
      for (uint32_t t = 0; t < triangles; ++t) write(view.triangle(t), 12, 4);
      for (size_t k = 0; k < written.size(); ++k)
        ASSERT_EQ(written[k], 1) << "byte " << k << " of kind " << kind << ", " << vertices << " vertices";
    }
}

}  // namespace
