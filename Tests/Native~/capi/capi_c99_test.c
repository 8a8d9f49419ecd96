/* SPDX-License-Identifier: MIT */
/* The header as a C99 program sees it, against the library as users link it. */
#include <quickses/quickses.h>
#include <quickses/quickses_gpu.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                                                      \
  do {                                                                                        \
    if (!(condition)) {                                                                       \
      fprintf(stderr, "%s:%d: %s (%s)\n", __FILE__, __LINE__, #condition, qses_last_error()); \
      ++failures;                                                                             \
    }                                                                                         \
  } while (0)

static void note_progress(void *user_data, double fraction) {
  double *last = (double *)user_data;
  if (fraction < *last) ++failures;
  *last = fraction;
}

/* From text in memory to the surface of a frame. */
static void check_files(qses_context *context) {
  static const char text[] =
      "MODEL        1\n"
      "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n"
      "ATOM      2  CA  ALA A   1       2.400   2.000   3.000  1.00  0.00           C\n"
      "ENDMDL\n"
      "MODEL        2\n"
      "ATOM      1  N   ALA A   1       1.000   2.500   3.000  1.00  0.00           N\n"
      "ATOM      2  CA  ALA A   1       2.400   2.500   3.000  1.00  0.00           C\n"
      "ENDMDL\n";
  const size_t size = sizeof text - 1;
  qses_structure_options read;
  qses_structure *structure = NULL;
  qses_structure_description info;
  qses_atom atom;
  qses_trajectory *trajectory = NULL;
  qses_trajectory_description trajectory_info;
  qses_frame frame;
  float xyz[6];
  uint32_t device_count = 0;

  CHECK(qses_device_count(&device_count) == QSES_OK);
  qses_structure_options_init(&read);
  read.format = QSES_STRUCTURE_PDB;
  read.selection = "//A/1/CA";
  CHECK(qses_structure_open_memory(text, size, &read, &structure) == QSES_OK);
  qses_structure_description_init(&info);
  CHECK(qses_structure_info(structure, &info) == QSES_OK);
  CHECK(info.atom_count == 1 && info.file_atom_count == 2 && info.model_count == 2);
  qses_atom_init(&atom);
  CHECK(qses_structure_atom(structure, 0, &atom) == QSES_OK);
  CHECK(strcmp(atom.name, "CA") == 0 && atom.element == 6);

  CHECK(qses_trajectory_open_memory(text, size, (qses_trajectory_format)6, &trajectory) == QSES_INVALID_ARGUMENT);
  CHECK(strstr(qses_last_error(), "format is 6") != NULL);
  CHECK(qses_trajectory_open_memory(text, size, QSES_TRAJECTORY_PDB, &trajectory) == QSES_OK);
  qses_trajectory_description_init(&trajectory_info);
  CHECK(qses_trajectory_info(trajectory, &trajectory_info) == QSES_OK);
  CHECK(trajectory_info.frame_count == 2 && trajectory_info.atom_count == 2);
  CHECK(qses_trajectory_unwrap(trajectory, info.file_elements, info.file_atom_count) == QSES_NO_BOX);
  qses_frame_init(&frame);
  CHECK(qses_trajectory_read_frame(trajectory, 1, xyz, 0, 2, &frame) == QSES_OK);
  CHECK(xyz[4] == 2.5f && frame.has_box == 0);

  CHECK(qses_set_atoms(context, info.positions, 0, info.radii, info.atom_count) == QSES_OK);
  CHECK(qses_set_positions_indexed(context, xyz, 0, 2, info.file_indices, info.atom_count) == QSES_OK);
  CHECK(qses_compute(context, NULL, NULL) == QSES_OK);
  qses_structure_close(structure);
  CHECK(qses_structure_open("nowhere.pdb", NULL, &structure) == QSES_FILE_ERROR);
  CHECK(structure == NULL);
  qses_trajectory_close(trajectory);
}

int main(void) {
  const float xyz[] = {0.0f, 0.0f, 0.0f, 1.5f, 0.2f, 0.0f, 0.1f, 1.4f, 0.3f};
  const float radii[] = {1.7f, 1.55f, 1.52f};
  qses_backend_description description;
  qses_context_options options;
  qses_context *context = NULL;
  qses_settings settings;
  qses_mesh mesh;
  qses_report report;
  qses_backend backend = QSES_BACKEND_AUTO;
  double progress = 0.0;
  uint32_t v, t;

  CHECK(qses_abi_version() == QSES_ABI_VERSION);
  CHECK(qses_gpu_abi_version() == QSES_GPU_ABI_VERSION);
  CHECK(qses_gpu_check_graphics((qses_graphics)0) == QSES_INVALID_ARGUMENT);
  CHECK(strstr(qses_last_error(), "graphics is 0") != NULL);
  CHECK(qses_gpu_check_graphics((qses_graphics)3) == QSES_INVALID_ARGUMENT);
  CHECK(strlen(qses_version()) >= 5);
  qses_backend_description_init(&description);
  CHECK(qses_backend_info(QSES_BACKEND_CPU, &description) == QSES_OK);
  CHECK(description.available == 1);
  CHECK(qses_backend_info((qses_backend)3, &description) == QSES_INVALID_ARGUMENT);
  CHECK(strstr(qses_last_error(), "backend is 3") != NULL);
  CHECK(qses_backend_info((qses_backend)-1, &description) == QSES_INVALID_ARGUMENT);
  CHECK(strstr(qses_last_error(), "backend is -1") != NULL);

  qses_context_options_init(&options);
  options.backend = QSES_BACKEND_CPU;
  options.threads = 1;
  CHECK(qses_context_create(&options, &context) == QSES_OK);
  if (!context) return 1;
  CHECK(qses_context_info(context, &backend, &description) == QSES_OK);
  CHECK(backend == QSES_BACKEND_CPU);
  CHECK(qses_set_progress_callback(context, note_progress, &progress) == QSES_OK);
  CHECK(qses_set_stage_times(context, 1) == QSES_OK);
  CHECK(qses_set_atoms(context, xyz, 3 * sizeof(float), radii, 3) == QSES_OK);

  qses_settings_init(&settings);
  settings.spacing = 0.25f;
  settings.patch_types = 1;
  settings.tag = 12;
  qses_mesh_init(&mesh);
  CHECK(qses_compute(context, &settings, &mesh) == QSES_OK);
  CHECK(progress == 1.0);
  CHECK(mesh.tag == 12);
  CHECK(mesh.vertex_count > 100);
  CHECK(mesh.triangle_count == 2 * mesh.vertex_count - 4); /* a closed piece without holes */
  for (v = 0; v < mesh.vertex_count; ++v) {
    const float *n = mesh.normals + 3 * v;
    if (mesh.owners[v] > 2 || mesh.patches[v] > QSES_PATCH_REENTRANT) ++failures;
    if (fabs(sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]) - 1.0) > 1e-5) ++failures;
  }
  for (t = 0; t < 3 * mesh.triangle_count; ++t)
    if (mesh.indices[t] >= mesh.vertex_count) ++failures;

  qses_report_init(&report);
  CHECK(qses_context_report(context, &report) == QSES_OK);
  CHECK(report.volume > 20.0 && report.volume < 100.0);
  CHECK(report.stage_count > 0 && strlen(report.stages[0].name) > 0);

  CHECK(qses_set_positions(context, xyz, 0, 3) == QSES_OK);
  settings.spacing = 0.0f;
  CHECK(qses_compute(context, &settings, NULL) == QSES_INVALID_ARGUMENT);
  CHECK(strstr(qses_last_error(), "spacing") != NULL);
  CHECK(qses_context_mesh(context, &mesh) == QSES_OK);
  CHECK(mesh.tag == 12);

  CHECK(qses_set_progress_callback(context, NULL, NULL) == QSES_OK); /* a second computation begins at 0 again */
  check_files(context);
  qses_context_destroy(context);
  if (failures) fprintf(stderr, "%d failures\n", failures);
  return failures ? 1 : 0;
}
