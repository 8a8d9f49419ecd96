// SPDX-License-Identifier: MIT
// Outputs that show a surface.
#include "cli/shown_output.h"

#include "io/mesh_writer.h"

namespace quickses::cli {

bool makes_shown(const Options &options) {
  const std::optional<io::MeshFormat> format = io::find_mesh_format(options.output);
  return format && io::format_traits_of(*format).is_shown;
}

bool makes_page(const Options &options) { return io::find_mesh_format(options.output) == io::MeshFormat::kHtml; }

bool has_outer_only(const Options &options) { return options.outer || makes_shown(options); }

}  // namespace quickses::cli
