/* SPDX-License-Identifier: MIT */
/* The plug-in as Unity uses it: a file that is loaded by its path, with functions looked up by name. Paths are UTF-8.
 * Needs nothing but the C library, so that programs run where nothing is installed. */
#ifndef QUICKSES_TEST_PLUGIN_H
#define QUICKSES_TEST_PLUGIN_H

#define QSES_STATIC /* the header's types; its functions are not linked */
#include <quickses/quickses.h>

#include <stdio.h>
#include <string.h>

#if defined(_WIN32)
#include <windows.h>

#include <shellapi.h>
#include <stdlib.h>

typedef HMODULE Library;

/* main's own arguments lack what the system's code page lacks. */
static void use_utf8_arguments(int *argc, char ***argv) {
  int i, count = 0;
  wchar_t **wide = CommandLineToArgvW(GetCommandLineW(), &count);
  char **utf8 = (char **)calloc((size_t)count + 1, sizeof *utf8);
  for (i = 0; wide && utf8 && i < count; ++i) {
    const int size = WideCharToMultiByte(CP_UTF8, 0, wide[i], -1, NULL, 0, NULL, NULL);
    utf8[i] = (char *)malloc((size_t)size);
    WideCharToMultiByte(CP_UTF8, 0, wide[i], -1, utf8[i], size, NULL, NULL);
  }
  *argc = count;
  *argv = utf8;
}
static void widen(const char *utf8, wchar_t *wide, int size) {
  if (MultiByteToWideChar(CP_UTF8, 0, utf8, -1, wide, size) == 0) wide[0] = 0;
}
static Library load_library(const char *path) {
  wchar_t wide[1024];
  widen(path, wide, 1024);
  return LoadLibraryW(wide);
}
static void *find_function(Library library, const char *name) { return (void *)GetProcAddress(library, name); }
static int unload_library(Library library) { return FreeLibrary(library) != 0; }
static const char *load_error(void) {
  static char text[32];
  snprintf(text, sizeof text, "error %lu", (unsigned long)GetLastError());
  return text;
}
#else
#include <dlfcn.h>

typedef void *Library;

static void use_utf8_arguments(int *argc, char ***argv) { (void)argc, (void)argv; }
static Library load_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find_function(Library library, const char *name) { return dlsym(library, name); }
static int unload_library(Library library) { return dlclose(library) == 0; }
static const char *load_error(void) { return dlerror(); }
#endif

/* clang-format off */
#define QSES_TEST_FUNCTIONS(F)                                                                         \
  F(qses_abi_version) F(qses_last_error) F(qses_context_create) F(qses_context_destroy)                \
  F(qses_set_atoms) F(qses_compute) F(qses_context_report)                                             \
  F(qses_begin) F(qses_cancel) F(qses_wait) F(qses_collect)                                            \
  F(qses_structure_open) F(qses_structure_info) F(qses_structure_close)
/* clang-format on */

/* A table of pointers, each of the type that the header declares the function with. */
#define QSES_TEST_MEMBER(name) __typeof__(&name) name##_;
typedef struct Plugin {
  Library library;
  QSES_TEST_FUNCTIONS(QSES_TEST_MEMBER)
} Plugin;

/* 0, or what went wrong is said and it is 1. */
static int open_plugin(Plugin *plugin, const char *path) {
  void *symbol;
  memset(plugin, 0, sizeof *plugin);
  plugin->library = load_library(path);
  if (!plugin->library) return fprintf(stderr, "%s can't be loaded: %s\n", path, load_error()), 1;
    /* ISO C has no conversion from object to function pointers; POSIX and Windows let the bytes be copied. */
#define QSES_TEST_FIND(name)                                             \
  symbol = find_function(plugin->library, #name);                        \
  if (!symbol) return fprintf(stderr, "%s has no " #name "\n", path), 1; \
  memcpy(&plugin->name##_, &symbol, sizeof symbol);
  QSES_TEST_FUNCTIONS(QSES_TEST_FIND)
  if (plugin->qses_abi_version_() != QSES_ABI_VERSION) return fprintf(stderr, "%s has another ABI version\n", path), 1;
  return 0;
}

static int failed(const Plugin *plugin, const char *what) {
  fprintf(stderr, "%s: %s\n", what, plugin->qses_last_error_());
  return 1;
}

/* Looks at a mesh of crambin (1CRN). */
static int check_crambin(const Plugin *plugin, const qses_structure_description *atoms, const qses_mesh *mesh,
                         const qses_report *report) {
  uint32_t i;
  /* 4664.9: the volume of the exact surface of 1CRN by quadrature. */
  if (!(report->volume > 0.995 * 4664.9 && report->volume < 1.005 * 4664.9))
    return failed(plugin, "volume is not that of 1CRN");
  for (i = 0; i < 3 * mesh->triangle_count; ++i)
    if (mesh->indices[i] >= mesh->vertex_count) return failed(plugin, "triangle without vertex");
  for (i = 0; i < mesh->vertex_count; ++i)
    if (mesh->owners[i] >= atoms->atom_count) return failed(plugin, "vertex without atom");
  return 0;
}

#endif
