// SPDX-License-Identifier: MIT
// quickses bench: times of warm calls, from atoms in memory to the mesh in memory.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "cli/commands.h"
#include "cli/engine.h"
#include "cli/exit_code.h"
#include "cli/report.h"
#include "cli/text_output.h"
#include "io/atomic_file.h"

namespace quickses::cli {
namespace {

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

void run_bench(const Options &options) {
  if (!options.json.empty() && options.json != "-") io::check_writable(options.json);
  std::vector<io::StructureFile> files;  // all of them first: a bad name should not cost a run
  for (const std::string &input : options.inputs)
    files.push_back(load(input, options.read, options.compute, options.quiet));

  Engine engine(options.compute);
  explain_fallback(engine, options.compute, options.quiet);
  qses_settings settings = settings_of(options.compute);
  settings.measure = 0;  // area and volume are no part of the mesh

  Json structures = Json::array();
  for (size_t i = 0; i < files.size(); ++i) {
    const io::Structure &structure = files[i].models.front();
    engine.set_atoms(structure, options.inputs[i]);
    qses_mesh mesh = engine.compute(settings);  // warms up: memory is taken here
    std::vector<double> times;
    for (unsigned k = 0; k < options.repeat; ++k) {
      const auto start = Clock::now();
      const qses_status status =
          qses_set_positions(engine.context(), structure.positions.data(), 0, structure.atoms.size());
      if (status != QSES_OK) throw Failure(exit_code_of(status), qses_last_error());
      mesh = engine.compute(settings);
      times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    const double host = median(times);
    structures.push_back({{"input", options.inputs[i]},
                          {"atoms", structure.atoms.size()},
                          {"vertices", mesh.vertex_count},
                          {"triangles", mesh.triangle_count},
                          {"host", host}});
    if (!options.quiet && options.json != "-") {
      std::printf("%s: %zu atoms, %u triangles, %s, host %.3f ms (median of %u)\n", options.inputs[i].c_str(),
                  structure.atoms.size(), mesh.triangle_count, name_of(engine.backend()), host, options.repeat);
      std::fflush(stdout);
    }
  }
  if (options.json.empty()) return;
  const Json json = {{"version", qses_version()}, {"backend", name_of(engine.backend())},
                     {"device", engine.device()}, {"settings", settings_json(options.compute)},
                     {"repeat", options.repeat},  {"structures", structures}};
  write_text(options.json, dump(json, false));
}

}  // namespace quickses::cli
