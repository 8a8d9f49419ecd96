/* SPDX-License-Identifier: MIT */
/* Runs the C of README.md, Documentation~/api.md and Documentation~/trajectories.md, as it stands there.
 *   page_examples_test STRUCTURE        STRUCTURE: 1CRN.pdb. Writes top.gro and md.xtc where it is started. */
#include <quickses/quickses_gpu.h>

#include <stdio.h>

/* What the pages define. */
struct ball {
  float x, y, z, radius;
};
int main_of_README(void);
int main_of_trajectories(void);
int show_backends(void);
qses_context *open_context(void);
int give_atoms(qses_context *context, const struct ball *balls, const float *radii, size_t count);
int move_atoms(qses_context *context, const struct ball *balls, size_t count);
int move_picked_atoms(qses_context *context, const float *frame, size_t frame_count, const uint32_t *indices,
                      size_t count);
int paint(qses_context *context, size_t count);
int compute_surface(qses_context *context, qses_mesh *mesh);
int mark_lining(const qses_mesh *mesh, uint8_t *mask, size_t atom_count);
size_t count_triangles(const qses_context *context);
int ask_for_surface(qses_context *context, uint32_t frame);
int take_surface(qses_context *context, qses_mesh *mesh);
int stop(qses_context *context);
int send_to_gpu(qses_context *context, qses_kept_mesh *kept, qses_gpu_target *target, const qses_gpu_buffers *buffers,
                qses_mesh *mesh);
int32_t event_of_frame(void);
void run_event(int32_t event);
int load_atoms(qses_context *context, const char *path);
int show_chain(qses_context *context, const qses_structure *structure);
int color_chains(qses_context *context, const qses_structure *structure);
int print_areas(qses_context *context, const void *bytes, size_t size, qses_trajectory_format format);

static int failures = 0;

#define CHECK(condition)                                                                      \
  do {                                                                                        \
    if (!(condition)) {                                                                       \
      fprintf(stderr, "%s:%d: %s (%s)\n", __FILE__, __LINE__, #condition, qses_last_error()); \
      ++failures;                                                                             \
    }                                                                                         \
  } while (0)

static void put_word(FILE *file, uint32_t word) {
  int shift;
  for (shift = 24; shift >= 0; shift -= 8) fputc((int)(word >> shift & 255), file);
}

static void put_float(FILE *file, float value) {
  uint32_t word;
  memcpy(&word, &value, sizeof word);
  put_word(file, word);
}

/* A molecule of two atoms and a water, and two frames of them, in nm; so few atoms are not packed in XTC files. */
static void write_trajectory(void) {
  static const float xyz[] = {0.1f, 0.2f, 0.3f, 0.22f, 0.2f, 0.3f, 1.0f, 1.0f, 1.0f};
  FILE *file = fopen("top.gro", "wb");
  uint32_t frame, k;
  CHECK(file != NULL);
  if (!file) return;
  fprintf(file, "A molecule and a water\n3\n");
  fprintf(file, "    1ALA      N    1%8.3f%8.3f%8.3f\n", xyz[0], xyz[1], xyz[2]);
  fprintf(file, "    1ALA     CA    2%8.3f%8.3f%8.3f\n", xyz[3], xyz[4], xyz[5]);
  fprintf(file, "    2SOL     OW    3%8.3f%8.3f%8.3f\n", xyz[6], xyz[7], xyz[8]);
  fprintf(file, "   2.00000   2.00000   2.00000\n");
  fclose(file);
  file = fopen("md.xtc", "wb");
  CHECK(file != NULL);
  if (!file) return;
  for (frame = 0; frame < 2; ++frame) {
    put_word(file, 1995);
    put_word(file, 3);
    put_word(file, frame);
    put_float(file, (float)frame);
    for (k = 0; k < 9; ++k) put_float(file, k % 4 == 0 ? 2.0f : 0.0f);
    put_word(file, 3);
    for (k = 0; k < 9; ++k) put_float(file, xyz[k] + 0.05f * (float)frame);
  }
  fclose(file);
}

/* A mesh that was not made on a GPU can't stay there. */
static void show_from_host(qses_context *context) {
  qses_gpu_target *target = NULL;
  qses_kept_mesh *kept = NULL;
  qses_gpu_buffers buffers;
  qses_mesh mesh;
  qses_gpu_buffers_init(&buffers);
  if (qses_gpu_target_create(&target) != QSES_OK) {
    CHECK(strstr(qses_last_error(), "without CUDA") != NULL);
    return;
  }
  CHECK(qses_kept_mesh_create(&kept) == QSES_OK);
  CHECK(ask_for_surface(context, 9) == QSES_OK);
  CHECK(qses_wait(context, -1, NULL) == QSES_OK);
  CHECK(send_to_gpu(context, kept, target, &buffers, &mesh) == -1);
  CHECK(qses_kept_mesh_view(kept, &mesh) == QSES_OK && mesh.positions != NULL);
  CHECK(event_of_frame() == 0);
  run_event(1); /* there is nothing to do */
  qses_kept_mesh_destroy(kept);
  qses_gpu_target_destroy(target);
}

static void run_api_page(qses_context *context, const char *path) {
  qses_structure *structure;
  static const struct ball balls[] = {{0, 0, 0, 1.7f}, {1.5f, 0, 0, 1.55f}, {0, 1.4f, 0, 1.52f}};
  static const float radii[] = {1.7f, 1.55f, 1.52f};
  static const float frame[] = {9, 9, 9, 0, 0, 0, 1.5f, 0, 0, 9, 9, 9, 0, 1.4f, 0};
  static const uint32_t picked[] = {1, 2, 4};
  static const char text[] =
      "MODEL        1\n"
      "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\n"
      "ATOM      2  CA  ALA A   1       2.400   2.000   3.000  1.00  0.00           C\n"
      "ATOM      3  C   ALA A   1       1.000   3.000   3.000  1.00  0.00           C\n"
      "ENDMDL\n";
  qses_mesh mesh;
  uint8_t lining[3] = {7, 7, 7};
  uint32_t v;
  int taken = 0, levels = 0, red = 0;

  CHECK(show_backends() == 0);
  CHECK(count_triangles(context) == 0);
  CHECK(give_atoms(context, balls, radii, 3) == QSES_OK);
  CHECK(move_atoms(context, balls, 3) == QSES_OK);
  CHECK(compute_surface(context, &mesh) == 0);
  CHECK(mesh.triangle_count == 2 * mesh.vertex_count - 4 && mesh.component_count == 1); /* closed, one piece */
  CHECK(count_triangles(context) == mesh.triangle_count);
  CHECK(mark_lining(&mesh, lining, 3) && !lining[0] && !lining[1] && !lining[2]); /* there is no cavity */
  v = mesh.vertex_count;
  CHECK(move_picked_atoms(context, frame, 5, picked, 3) == QSES_OK);
  CHECK(compute_surface(context, &mesh) == 0);
  CHECK(mesh.vertex_count == v); /* the same places */
  CHECK(print_areas(context, text, sizeof text - 1, QSES_TRAJECTORY_PDB) == 0);

  CHECK(paint(context, 3) == QSES_OK);
  CHECK(compute_surface(context, &mesh) == 0);
  for (v = 0; v < mesh.vertex_count; ++v) {
    CHECK(mesh.owners[v] < 3 && mesh.colors[4 * v] == 255);
    red += mesh.colors[4 * v + 1] == 0;
  }
  CHECK(red > 0 && red < (int)mesh.vertex_count);
  CHECK(mesh.triangle_count < 2 * mesh.vertex_count - 4); /* open where the last atom is hidden */

  CHECK(load_atoms(context, path) == 0);
  CHECK(load_atoms(context, "nowhere.pdb") == 1);
  CHECK(qses_structure_open(path, NULL, &structure) == QSES_OK);
  CHECK(show_chain(context, structure) == 0);
  CHECK(color_chains(context, structure) == 0);
  qses_structure_close(structure);
  CHECK(take_surface(context, &mesh) == 0);
  CHECK(ask_for_surface(context, 7) == QSES_OK);
  while (taken == 0 || mesh.level + 1 < mesh.level_count) {
    taken = take_surface(context, &mesh);
    CHECK(taken >= 0);
    if (taken < 0) break;
    if (taken == 0) continue;
    CHECK(mesh.tag == 7 && mesh.vertex_bytes == 24);
    ++levels;
  }
  CHECK(levels >= 1 && levels <= 3);
  CHECK(ask_for_surface(context, 8) == QSES_OK);
  CHECK(stop(context) == 0);
  show_from_host(context);
}

int main(int argc, char **argv) {
  qses_context *context;
  if (argc != 2) return fprintf(stderr, "usage: page_examples_test STRUCTURE\n"), 2;
  context = open_context();
  CHECK(context != NULL);
  if (context) run_api_page(context, argv[1]);
  qses_context_destroy(context);
  CHECK(main_of_README() == 0);
  write_trajectory();
  CHECK(main_of_trajectories() == 0);
  if (failures) fprintf(stderr, "%d failures\n", failures);
  return failures ? 1 : 0;
}
