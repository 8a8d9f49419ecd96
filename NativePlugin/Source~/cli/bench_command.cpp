// SPDX-License-Identifier: MIT
// quickses bench: times of warm calls.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <future>
#include <utility>

#include "cli/bench.h"
#include "cli/commands.h"
#include "cli/copies.h"
#include "cli/engine_pool.h"
#include "cli/exit_code.h"
#include "cli/input.h"
#include "cli/processes.h"
#include "cli/text_output.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

constexpr size_t kSmallSurfaces = 100;
constexpr unsigned kMostInFlight = 8;  // small surfaces on a GPU
constexpr double kGap = 4;             // Å between copies, besides room for two probes and two cells of the lattice

// First atom of each residue, and the number of atoms.
std::vector<size_t> find_residues(const io::Structure &structure) {
  const std::vector<uint32_t> residues = io::residues_of(structure);
  std::vector<size_t> starts;
  for (size_t i = 0; i < residues.size(); ++i)
    if (i == 0 || residues[i] != residues[i - 1]) starts.push_back(i);
  starts.push_back(residues.size());
  return starts;
}

struct Window {
  size_t first, count;  // atoms
};

// Runs of whole residues with at least `atoms` atoms, or the whole molecule if it has fewer. They start at one residue
// after the other, and at the first one again where the rest is too short.
std::vector<Window> cut_windows(const io::Structure &structure, size_t atoms) {
  const std::vector<size_t> starts = find_residues(structure);
  std::vector<Window> all;
  for (size_t r = 0; r + 1 < starts.size(); ++r) {
    size_t end = r;
    while (end + 1 < starts.size() && starts[end] - starts[r] < atoms) ++end;
    if (r == 0 || starts[end] - starts[r] >= atoms) all.push_back({starts[r], starts[end] - starts[r]});
  }
  std::vector<Window> windows;
  for (size_t k = 0; k < kSmallSurfaces; ++k) windows.push_back(all[k % all.size()]);
  return windows;
}

}  // namespace

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

qses_settings bench_settings(const Options &options) {
  qses_settings settings = settings_of(options.compute);
  settings.measure = options.bench.measure;
  settings.vertex_layout = options.bench.layout;
  settings.without_owners = options.bench.without_owners;
  return settings;
}

Engine start_engine(const BenchSubject &subject) {
  Engine engine = start_engine(subject.options.compute, true);
  engine.set_atoms(subject.structure, subject.path);
  return engine;
}

namespace {

void compute_window(Engine &engine, const io::Structure &structure, const Window &w, const qses_settings &settings) {
  if (qses_set_atoms(engine.context(), &structure.positions[3 * w.first], 0, &structure.radii[w.first], w.count) !=
      QSES_OK)
    throw Failure(kComputingFailed, qses_last_error());
  engine.compute(settings);
}

// As many at a time as there are engines.
void compute_windows(EnginePool &engines, unsigned in_flight, const io::Structure &structure,
                     const std::vector<Window> &windows, const qses_settings &settings) {
  std::atomic<size_t> next{0};
  std::vector<std::future<void>> workers;  // where the system refuses them, this thread does their work
  for (unsigned n = 0; n < in_flight; ++n)
    workers.push_back(std::async(std::launch::async | std::launch::deferred, [&] {
      for (size_t k; (k = next++) < windows.size();)
        engines.run([&](Engine &engine) { compute_window(engine, structure, windows[k], settings); });
    }));
  for (std::future<void> &worker : workers) worker.wait();
  for (std::future<void> &worker : workers) worker.get();
}

}  // namespace

std::string bench_small(const BenchSubject &subject, Json *entry) {
  const auto &[structure, path, options, backend] = subject;
  const unsigned threads = options.compute.threads ? options.compute.threads : Processes().threads();
  const unsigned in_flight = backend == QSES_BACKEND_CUDA ? std::clamp(threads, 2u, kMostInFlight) : threads;
  ComputeOptions share = options.compute;
  share.threads = std::max(1u, threads / in_flight);
  if (share.memory != 0) share.memory = std::max<uint64_t>(1, share.memory / in_flight);
  EnginePool engines(share, std::vector<int>(in_flight, chosen_devices(share, 0).front()), [](Engine &) {});
  const std::vector<Window> windows = cut_windows(structure, options.bench.small);
  const qses_settings settings = bench_settings(options);
  size_t fewest = windows.front().count, most = fewest;
  for (const Window &w : windows) {
    fewest = std::min(fewest, w.count);
    most = std::max(most, w.count);
  }
  std::vector<double> times;
  for (unsigned k = 0; k <= options.bench.repeat; ++k) {
    const auto start = Clock::now();
    compute_windows(engines, in_flight, structure, windows, settings);
    if (k > 0) times.push_back(ms_since(start));  // the first round warms up
  }
  const double total = median(times);
  (*entry)["small"] = {{"surfaces", windows.size()},
                       {"in_flight", in_flight},
                       {"fewest_atoms", fewest},
                       {"most_atoms", most},
                       {"total", total}};
  char text[200];
  std::snprintf(text, sizeof text, "%zu surfaces of %zu to %zu atoms, %u at a time, %s, %.3f ms in all (median of %u)",
                windows.size(), fewest, most, in_flight, name_of(backend), total, options.bench.repeat);
  return text;
}

void run_bench(const Options &options) {
  const BenchOptions &bench = options.bench;
  check_text_output(options.json);
  std::vector<io::StructureFile> files;  // all of them first: a bad name should not cost a run
  for (const std::string &input : options.inputs) files.push_back(load(input, options, options.quiet));

  const Engine first = start_engine(options.compute, options.quiet);  // starts CUDA; nothing is computed with it
  const bool needs_device = bench.deliveries == Deliveries::kDevice || bench.deliveries == Deliveries::kBoth;
  if (needs_device && first.backend() == QSES_BACKEND_CPU)
    throw Failure(kBackendUnavailable, "--delivery: meshes stay on CUDA devices only: " + first.why_not_cuda());
  Json structures = Json::array();
  for (size_t i = 0; i < files.size(); ++i) {
    const double gap = 2 * options.compute.probe + 2 * options.compute.spacing + kGap;
    const io::Structure structure =
        make_copies(std::move(files[i].models.front()), bench.copies, static_cast<float>(options.compute.spacing), gap);
    const BenchSubject subject = {structure, options.inputs[i], options, first.backend()};
    Json entry = {{"input", options.inputs[i]}, {"atoms", structure.atoms.size()}};
    const auto measure = bench.jobs ? bench_jobs : bench.small > 0 ? bench_small : bench_surface;
    const std::string text = measure(subject, &entry);
    structures.push_back(entry);
    if (!options.quiet && options.json != "-") {
      std::printf("%s: %s, %s\n", options.inputs[i].c_str(), io::counted(structure.atoms.size(), "atom").c_str(),
                  text.c_str());
      flush_standard_output();
    }
  }
  if (options.json.empty()) return;
  Json settings = settings_json(options.compute);
  settings["layout"] = name_of(bench.layout);
  if (bench.without_owners) settings["owners"] = false;
  const Json json = {{"schema", kReportSchema},  {"version", qses_version()}, {"backend", name_of(first.backend())},
                     {"device", first.device()}, {"settings", settings},      {"copies", bench.copies},
                     {"repeat", bench.repeat},   {"structures", structures}};
  write_text(options.json, dump(json, false));
}

}  // namespace quickses::cli
