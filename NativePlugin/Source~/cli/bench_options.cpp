// SPDX-License-Identifier: MIT
// The flags of quickses bench.
#include "cli/bench_options.h"

#include <map>

#include "cli/exit_code.h"
#include "cli/help_format.h"
#include "cli/option_kinds.h"

namespace quickses::cli {
namespace {

const std::map<std::string, qses_vertex_layout> kLayouts = {{"separate", QSES_VERTICES_SEPARATE},
                                                            {"interleaved", QSES_VERTICES_INTERLEAVED},
                                                            {"compact", QSES_VERTICES_COMPACT}};
const std::map<std::string, Deliveries> kDeliveries = {
    {"host", Deliveries::kHost}, {"device", Deliveries::kDevice}, {"both", Deliveries::kBoth}};

}  // namespace

void add_bench_options(CLI::App *app, BenchOptions &options) {
  add_count(app, "--repeat", "--repeat", options.repeat, 1, 1000000, "Timed calls per structure; default 20");
  app->add_option_function<std::string>(
         "--delivery",
         [&options](const std::string &text) { options.deliveries = look_up("--delivery", kDeliveries, text); },
         "Where the mesh is when the time is up: in host memory, or on the CUDA device without a download. Default: "
         "both with CUDA, host on the CPU")
      ->type_name("host|device|both");
  add_choice(app, "--layout", options.layout, kLayouts,
             "Bytes of a vertex: 24 in two arrays (separate) or one (interleaved), or 16 with rounded normals");
  app->add_flag("--no-owners", options.without_owners, "Without the atom of each vertex, 4 bytes, in host memory");
  add_count(app, "--copies", "--copies", options.copies, 1, 10000,
            "Copies of each structure side by side on a grid, to see how times grow; default 1");
  app->add_flag("--measure", options.measure, "With area and volume");
  app->add_flag("--stages", options.stages, "The time of each stage as well, in as many calls of their own");
  add_count(app, "--small", "--small", options.small, 1, 1000000,
            "Time 100 surfaces of at least N atoms each instead, cut between residues, several at a time");
  app->add_flag("--jobs", options.jobs,
                "Time jobs instead: begin, cancel, destroy, the first level, and all levels against the finest alone");
  put_rest_into_group(app, "Timing");
}

void check_bench(const Options &options, const std::function<bool(const char *)> &given) {
  if (options.inputs.empty()) throw Failure(kUsage, "bench: no input file was given");
  const BenchOptions &bench = options.bench;
  if (bench.jobs && bench.small > 0) throw Failure(kUsage, "--jobs and --small: one at a time");
  if (bench.small > 0 && given("--copies"))
    throw Failure(kUsage, "--copies: --small cuts surfaces out of one molecule, and copies have the same ones");
  if (bench.jobs || bench.small > 0)
    for (const char *flag : {"--delivery", "--stages"})
      if (given(flag)) throw Failure(kUsage, std::string(flag) + ": not with --jobs and --small");
  const bool is_cpu = options.compute.backend == QSES_BACKEND_CPU;
  if (is_cpu && (bench.deliveries == Deliveries::kDevice || bench.deliveries == Deliveries::kBoth))
    throw Failure(kUsage, "--delivery: meshes stay on CUDA devices only, and --backend is cpu");
}

const char *name_of(qses_vertex_layout layout) { return find_name(kLayouts, layout); }

}  // namespace quickses::cli
