/* SPDX-License-Identifier: MIT
 *
 * A user of the library in another project: one atom must give a closed mesh (V - E + F = 2) of its own radius.
 */
#include <quickses/quickses.h>

#include <stdio.h>

static int fail(const char *what) {
  fprintf(stderr, "%s: %s\n", what, qses_last_error());
  return 1;
}

int main(void) {
  const float position[3] = {1.0f, 2.0f, 3.0f};
  const float radius = 1.7f;
  qses_context_options options;
  qses_settings settings;
  qses_mesh mesh;
  qses_context *context = NULL;

  if (qses_abi_version() != QSES_ABI_VERSION) return fail("the library is of another version than its header");
  qses_context_options_init(&options);
  qses_settings_init(&settings);
  qses_mesh_init(&mesh);
  options.backend = QSES_BACKEND_CPU;
  if (qses_context_create(&options, &context) != QSES_OK) return fail("qses_context_create");
  if (qses_set_atoms(context, position, 0, &radius, 1) != QSES_OK) return fail("qses_set_atoms");
  if (qses_compute(context, &settings, &mesh) != QSES_OK) return fail("qses_compute");
  if (mesh.vertex_count < 12 || mesh.triangle_count != 2 * mesh.vertex_count - 4) {
    fprintf(stderr, "%lu vertices and %lu triangles are no closed sphere\n", (unsigned long)mesh.vertex_count,
            (unsigned long)mesh.triangle_count);
    return 1;
  }
  for (size_t v = 0; v < (size_t)mesh.vertex_count; ++v) {
    double squared = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double d = (double)mesh.positions[3 * v + k] - (double)position[k];
      squared += d * d;
    }
    if (squared < 1.69 * 1.69 || squared > 1.71 * 1.71) return fail("a vertex is off the sphere");
  }
  qses_context_destroy(context);
  return 0;
}
