/* SPDX-License-Identifier: MIT */
/* The plug-in computes a surface where nothing is installed.
 *   plugin_load_test PLUGIN STRUCTURE        STRUCTURE: 1CRN.pdb */
#include "capi/plugin.h"

static int compute(const Plugin *plugin, const char *path) {
  qses_structure *structure = NULL;
  qses_structure_description info;
  qses_context *context = NULL;
  qses_mesh mesh;
  qses_report report;

  if (plugin->qses_structure_open_(path, NULL, &structure) != QSES_OK) return failed(plugin, "qses_structure_open");
  qses_structure_description_init(&info);
  if (plugin->qses_structure_info_(structure, &info) != QSES_OK) return failed(plugin, "qses_structure_info");
  if (plugin->qses_context_create_(NULL, &context) != QSES_OK) return failed(plugin, "qses_context_create");
  if (plugin->qses_set_atoms_(context, info.positions, 0, info.radii, info.atom_count) != QSES_OK)
    return failed(plugin, "qses_set_atoms");
  qses_mesh_init(&mesh);
  if (plugin->qses_compute_(context, NULL, &mesh) != QSES_OK) return failed(plugin, "qses_compute");
  qses_report_init(&report);
  if (plugin->qses_context_report_(context, &report) != QSES_OK) return failed(plugin, "qses_context_report");
  printf("%u atoms, %u vertices, %u triangles, volume %.2f cubic angstrom\n", (unsigned)info.atom_count,
         (unsigned)mesh.vertex_count, (unsigned)mesh.triangle_count, report.volume);
  if (check_crambin(plugin, &info, &mesh, &report)) return 1;
  plugin->qses_structure_close_(structure);
  plugin->qses_context_destroy_(context);
  return 0;
}

int main(int argc, char **argv) {
  Plugin plugin;
  use_utf8_arguments(&argc, &argv);
  if (argc != 3) {
    fprintf(stderr, "usage: plugin_load_test PLUGIN STRUCTURE\n");
    return 2;
  }
  return open_plugin(&plugin, argv[1]) || compute(&plugin, argv[2]) || !unload_library(plugin.library);
}
