/* SPDX-License-Identifier: MIT */
/* The plug-in in a host that loads it from two places, takes it away and loads it again.
 *   plugin_reload_test STRUCTURE FOLDER PLUGIN
 * STRUCTURE is 1CRN.pdb. FOLDER is there; copies are made in it, in folders that are called as people are. */
#include "capi/plugin.h"

#include <stdlib.h>

#define FIRST "J\xc3\xbcrgen M\xc3\xbcller \xe6\x9d\x8e"
#define SECOND "\xce\xa3\xce\xbf\xcf\x86\xce\xaf\xce\xb1 \xf0\x9f\xa7\xac"

enum { kPath = 1024, kWarmRounds = 5, kRounds = 20 };

/* ---- the system ---------------------------------------------------------------------------------------------- */

#if defined(_WIN32)
#define PSAPI_VERSION 2
#include <psapi.h>
#include <tlhelp32.h>

static void make_folder(const char *path) {
  wchar_t wide[kPath];
  widen(path, wide, kPath);
  CreateDirectoryW(wide, NULL);
}
static FILE *open_file(const char *path, const char *mode) {
  wchar_t wide[kPath], wide_mode[8];
  widen(path, wide, kPath);
  widen(mode, wide_mode, 8);
  return _wfopen(wide, wide_mode);
}
static unsigned long memory_in_use(void) {
  PROCESS_MEMORY_COUNTERS counters;
  GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters);
  return (unsigned long)(counters.PagefileUsage >> 10);
}
/* And threads. */
static unsigned long handles_in_use(void) {
  DWORD count = 0;
  THREADENTRY32 thread;
  HANDLE threads = CreateToolhelp32Snapshot(TH32CS_SNAPTHREAD, 0);
  thread.dwSize = sizeof thread;
  GetProcessHandleCount(GetCurrentProcess(), &count);
  if (Thread32First(threads, &thread)) do
      if (thread.th32OwnerProcessID == GetCurrentProcessId()) ++count;
    while (Thread32Next(threads, &thread));
  CloseHandle(threads);
  return count;
}
static int is_loaded(const char *path) {
  wchar_t wide[kPath];
  HMODULE module = NULL;
  widen(path, wide, kPath);
  return GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT, wide, &module) != 0;
}
#else
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

static void make_folder(const char *path) { mkdir(path, 0777); }
static FILE *open_file(const char *path, const char *mode) { return fopen(path, mode); }
/* Its own, wherever that is: how much of files is in memory is the system's business. */
static unsigned long memory_in_use(void) {
  unsigned long sum = 0, part = 0;
  char line[256];
  FILE *file = fopen("/proc/self/status", "r");
  while (file && fgets(line, sizeof line, file))
    if (sscanf(line, "RssAnon: %lu kB", &part) == 1 || sscanf(line, "VmSwap: %lu kB", &part) == 1) sum += part;
  if (file) fclose(file);
  return sum;
}
static unsigned long entries_of(const char *folder) {
  unsigned long count = 0;
  DIR *entries = opendir(folder);
  while (entries && readdir(entries)) ++count;
  if (entries) closedir(entries);
  return count;
}
static unsigned long handles_in_use(void) { return entries_of("/proc/self/fd") + entries_of("/proc/self/task"); }
static int is_loaded(const char *path) {
  void *library = dlopen(path, RTLD_NOW | RTLD_NOLOAD);
  if (library) dlclose(library);
  return library != NULL;
}
#endif

/* ---- copies -------------------------------------------------------------------------------------------------- */

static const char *name_of(const char *path) {
  const char *name = path;
  for (; *path; ++path)
    if (*path == '/' || *path == '\\') name = path + 1;
  return name;
}

static int copy_file(const char *from, const char *to) {
  static char buffer[65536];
  size_t size = 0;
  FILE *in = open_file(from, "rb"), *out = open_file(to, "wb");
  if (!in || !out) return fprintf(stderr, "%s can't be copied to %s\n", from, to), 1;
  while ((size = fread(buffer, 1, sizeof buffer, in)) > 0)
    if (fwrite(buffer, 1, size, out) != size) return 1;
  fclose(in);
  return fclose(out);
}

/* Copies the plug-in and the structure to FOLDER/name; gives their paths there. */
static int copy_both(char **arguments, const char *name, char *plugin, char *structure) {
  char folder[kPath];
  if (strlen(arguments[2]) > kPath / 2) return fprintf(stderr, "the folder's name is too long\n"), 1;
  snprintf(folder, kPath, "%.500s/%s", arguments[2], name);
  make_folder(folder);
  snprintf(plugin, kPath, "%.700s/%.200s", folder, name_of(arguments[3]));
  snprintf(structure, kPath, "%.700s/%.200s", folder, name_of(arguments[1]));
  return copy_file(arguments[3], plugin) || copy_file(arguments[1], structure);
}

/* ---- what is done with a copy -------------------------------------------------------------------------------- */

typedef struct Work {
  Plugin plugin;
  qses_structure *structure;
  qses_structure_description atoms;
  qses_context *context;
} Work;

static int begin_work(Work *work, const char *plugin, const char *structure) {
  qses_context_options options;
  if (open_plugin(&work->plugin, plugin)) return 1;
  qses_context_options_init(&options);
  options.threads = 4;
  qses_structure_description_init(&work->atoms);
  if (work->plugin.qses_structure_open_(structure, NULL, &work->structure) != QSES_OK ||
      work->plugin.qses_structure_info_(work->structure, &work->atoms) != QSES_OK ||
      work->plugin.qses_context_create_(&options, &work->context) != QSES_OK ||
      work->plugin.qses_set_atoms_(work->context, work->atoms.positions, 0, work->atoms.radii,
                                   work->atoms.atom_count) != QSES_OK ||
      work->plugin.qses_begin_(work->context, NULL) != QSES_OK)
    return failed(&work->plugin, plugin);
  return 0;
}

static int collect(Work *work, qses_mesh *mesh) {
  qses_report report;
  qses_mesh_init(mesh);
  qses_report_init(&report);
  if (work->plugin.qses_wait_(work->context, -1, NULL) != QSES_OK ||
      work->plugin.qses_collect_(work->context, mesh) != QSES_OK ||
      work->plugin.qses_context_report_(work->context, &report) != QSES_OK)
    return failed(&work->plugin, "the surface");
  return check_crambin(&work->plugin, &work->atoms, mesh, &report);
}

static int end_work(Work *work) {
  work->plugin.qses_structure_close_(work->structure);
  work->plugin.qses_context_destroy_(work->context);
  return unload_library(work->plugin.library) ? 0 : (fprintf(stderr, "it can't be unloaded: %s\n", load_error()), 1);
}

static int are_alike(const qses_mesh *a, const qses_mesh *b) {
  return a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count &&
         memcmp(a->positions, b->positions, (size_t)a->vertex_count * 12) == 0 &&
         memcmp(a->indices, b->indices, (size_t)a->triangle_count * 12) == 0;
}

/* Two copies compute at a time, and make the same. */
static int compute_with_both(const char *first, const char *second, const char *structure) {
  Work a, b;
  qses_mesh of_a, of_b;
  if (begin_work(&a, first, structure) || begin_work(&b, second, structure)) return 1;
  if (a.plugin.library == b.plugin.library || a.plugin.qses_compute_ == b.plugin.qses_compute_)
    return fprintf(stderr, "the two copies are one\n"), 1;
  if (collect(&a, &of_a) || collect(&b, &of_b)) return 1;
  if (!are_alike(&of_a, &of_b)) return fprintf(stderr, "the two copies make different meshes\n"), 1;
  return end_work(&a) || end_work(&b);
}

/* It goes after it has computed, or while a job was just cancelled. */
static int compute_and_unload(const char *plugin, const char *structure, int cancels) {
  Work work;
  qses_mesh mesh;
  if (begin_work(&work, plugin, structure)) return 1;
  if (cancels ? work.plugin.qses_cancel_(work.context) != QSES_OK : collect(&work, &mesh)) return 1;
  return end_work(&work);
}

int main(int argc, char **argv) {
  static char first[kPath], second[kPath], structure[kPath], another[kPath];
  unsigned long memory = 0, handles = 0;
  int round;
  use_utf8_arguments(&argc, &argv);
  if (argc != 4) return fprintf(stderr, "usage: plugin_reload_test STRUCTURE FOLDER PLUGIN\n"), 2;
  if (copy_both(argv, FIRST, first, structure) || copy_both(argv, SECOND, second, another)) return 1;
  if (compute_with_both(first, second, structure)) return 1;
  for (round = 0; round < kWarmRounds + kRounds; ++round) {
    if (compute_and_unload(first, another, 0) || compute_and_unload(first, structure, 1) ||
        compute_and_unload(second, structure, round % 2))
      return 1;
    if (round + 1 == kWarmRounds) {
      memory = memory_in_use();
      handles = handles_in_use();
    }
  }
  if (memory_in_use() > memory + 6144) return fprintf(stderr, "memory grows from load to load\n"), 1;
  if (handles_in_use() > handles + 4) return fprintf(stderr, "handles or threads grow from load to load\n"), 1;
  if (!is_loaded(first) || !is_loaded(second)) return fprintf(stderr, "code of sleeping threads was unloaded\n"), 1;
  printf("after %d rounds %lu KiB and %lu handles and threads, after %d more %lu KiB and %lu\n", kWarmRounds, memory,
         handles, kRounds, memory_in_use(), handles_in_use());
  return 0;
}
