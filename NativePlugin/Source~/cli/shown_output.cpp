// SPDX-License-Identifier: MIT
// Outputs that show a surface.
#include "cli/shown_output.h"

#include "io/error.h"
#include "io/mesh_writer.h"

namespace quickses::cli {
namespace {

// Of a name that is none of a mesh: nothing.
std::optional<io::MeshFormat> format_of(const Options &options) {
  if (options.output.empty()) return std::nullopt;
  try {
    return io::mesh_format_of(options.output);
  } catch (const io::Error &) {
    return std::nullopt;
  }
}

}  // namespace

bool makes_shown(const Options &options) {
  const std::optional<io::MeshFormat> format = format_of(options);
  return format && io::is_shown(*format);
}

bool makes_page(const Options &options) { return format_of(options) == io::MeshFormat::kHtml; }

}  // namespace quickses::cli
