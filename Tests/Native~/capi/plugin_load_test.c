/* SPDX-License-Identifier: MIT */
/* The plug-in as Unity uses it: a file that is loaded by its path, with functions looked up by name.
 *   plugin_load_test PLUGIN STRUCTURE        STRUCTURE: 1CRN.pdb
 * It is linked to nothing but the C library, so it also shows what the plug-in needs on a machine where nothing is
 * installed. */
#define QSES_STATIC /* the header's types; its functions are not linked */
#include <quickses/quickses.h>

#include <stdio.h>
#include <string.h>

#if defined(_WIN32)
#include <windows.h>
typedef HMODULE Library;
static Library load(const char *path) { return LoadLibraryA(path); }
static void *find(Library library, const char *name) { return (void *)GetProcAddress(library, name); }
static const char *load_error(void) {
  static char text[32];
  snprintf(text, sizeof text, "error %lu", (unsigned long)GetLastError());
  return text;
}
#else
#include <dlfcn.h>
typedef void *Library;
static Library load(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(Library library, const char *name) { return dlsym(library, name); }
static const char *load_error(void) { return dlerror(); }
#endif

/* clang-format off */
#define FUNCTIONS(F)                                                                                   \
  F(qses_abi_version) F(qses_last_error) F(qses_context_create) F(qses_context_destroy)                \
  F(qses_set_atoms) F(qses_compute) F(qses_context_report)                                             \
  F(qses_structure_open) F(qses_structure_info) F(qses_structure_close)
/* clang-format on */

/* A table of pointers, each of the type that the header declares the function with. */
#define MEMBER(name) __typeof__(&name) name##_;
static struct { FUNCTIONS(MEMBER) } api;

static int failed(const char *what) {
  fprintf(stderr, "%s: %s\n", what, api.qses_last_error_ ? api.qses_last_error_() : "");
  return 1;
}

static int compute(const char *path) {
  qses_structure *structure = NULL;
  qses_structure_description info;
  qses_context *context = NULL;
  qses_mesh mesh;
  qses_report report;
  uint32_t i;

  if (api.qses_abi_version_() != QSES_ABI_VERSION) return failed("another ABI version");
  if (api.qses_structure_open_(path, NULL, &structure) != QSES_OK) return failed("qses_structure_open");
  qses_structure_description_init(&info);
  if (api.qses_structure_info_(structure, &info) != QSES_OK) return failed("qses_structure_info");
  if (api.qses_context_create_(NULL, &context) != QSES_OK) return failed("qses_context_create");
  if (api.qses_set_atoms_(context, info.positions, 0, info.radii, info.atom_count) != QSES_OK)
    return failed("qses_set_atoms");
  qses_mesh_init(&mesh);
  if (api.qses_compute_(context, NULL, &mesh) != QSES_OK) return failed("qses_compute");
  qses_report_init(&report);
  if (api.qses_context_report_(context, &report) != QSES_OK) return failed("qses_context_report");
  printf("%u atoms, %u vertices, %u triangles, volume %.2f cubic angstrom\n", (unsigned)info.atom_count,
         (unsigned)mesh.vertex_count, (unsigned)mesh.triangle_count, report.volume);

  /* 4664.9: the volume of the exact surface of 1CRN by quadrature. */
  if (!(report.volume > 0.995 * 4664.9 && report.volume < 1.005 * 4664.9)) return failed("volume is not that of 1CRN");
  for (i = 0; i < 3 * mesh.triangle_count; ++i)
    if (mesh.indices[i] >= mesh.vertex_count) return failed("triangle without vertex");
  for (i = 0; i < mesh.vertex_count; ++i)
    if (mesh.owners[i] >= info.atom_count) return failed("vertex without atom");
  api.qses_structure_close_(structure);
  api.qses_context_destroy_(context);
  return 0;
}

int main(int argc, char **argv) {
  Library library;
  void *symbol;
  if (argc != 3) {
    fprintf(stderr, "usage: plugin_load_test PLUGIN STRUCTURE\n");
    return 2;
  }
  library = load(argv[1]);
  if (!library) {
    fprintf(stderr, "%s can't be loaded: %s\n", argv[1], load_error());
    return 1;
  }
  /* ISO C has no conversion from object to function pointers; POSIX and Windows let the bytes be copied. */
#define FIND(name)                                                          \
  symbol = find(library, #name);                                            \
  if (!symbol) return fprintf(stderr, "%s has no " #name "\n", argv[1]), 1; \
  memcpy(&api.name##_, &symbol, sizeof symbol);
  FUNCTIONS(FIND)
  return compute(argv[2]);
}
