// SPDX-License-Identifier: MIT
// quickses bench: warm surfaces, one after the other in one context, for each place where the mesh may be wanted.
#include <algorithm>
#include <cstdio>
#include <utility>

#include "cli/bench.h"

namespace quickses::cli {
namespace {

// The first takes memory. The second takes another buffer for its mesh, since the first mesh is still the caller's.
constexpr unsigned kWarmUps = 2;

// Of the atoms in host memory. What was delivered is finished, also on the device.
qses_mesh make_surface(Engine &engine, const io::Structure &structure, const qses_settings &settings) {
  engine.set_positions(structure);
  const qses_mesh mesh = engine.compute(settings);
  return settings.delivery == QSES_DELIVERY_DEVICE ? engine.collect_device().mesh : mesh;
}

// Times of one stage, in the order of the calls.
using StageTimes = std::vector<std::pair<std::string, std::vector<double>>>;

void add_stages(const qses_report &report, StageTimes *stages) {
  for (uint32_t i = 0; i < report.stage_count && i < QSES_MAX_STAGES; ++i) {
    const std::string name = report.stages[i].name;
    auto stage = std::find_if(stages->begin(), stages->end(), [&](const auto &s) { return s.first == name; });
    if (stage == stages->end()) stage = stages->insert(stage, {name, {}});
    stage->second.push_back(report.stages[i].milliseconds);
  }
}

struct Delivered {
  qses_mesh mesh;
  std::vector<double> times;
  StageTimes stages;
  qses_report report;
};

Delivered deliver(const BenchSubject &subject, qses_delivery delivery) {
  qses_settings settings = bench_settings(subject.options);
  settings.delivery = delivery;
  const unsigned repeat = subject.options.bench.repeat;
  Engine engine = start_engine(subject);
  Delivered found = {};
  for (unsigned k = 0; k < kWarmUps; ++k) make_surface(engine, subject.structure, settings);
  for (unsigned k = 0; k < repeat; ++k) {
    const auto start = Clock::now();
    found.mesh = make_surface(engine, subject.structure, settings);
    found.times.push_back(ms_since(start));
  }
  found.report = engine.report();
  if (!subject.options.bench.stages) return found;
  qses_set_stage_times(engine.context(), 1);  // which takes time itself, so those above are without
  for (unsigned k = 0; k < repeat; ++k) {
    make_surface(engine, subject.structure, settings);
    add_stages(engine.report(), &found.stages);
  }
  return found;
}

Json times_json(const Delivered &found, qses_backend backend) {
  Json json = {{"median", median(found.times)}, {"min", *std::min_element(found.times.begin(), found.times.end())}};
  for (const auto &[name, times] : found.stages) json["stages"][name] = median(times);
  json["memory"] = memory_json(found.report, backend);
  return json;
}

std::string stage_lines(const char *place, const StageTimes &stages) {
  std::string lines;
  for (const auto &[name, times] : stages) {
    char text[120];
    std::snprintf(text, sizeof text, "\n  %-6s %-18s %9.3f ms", place, name.c_str(), median(times));
    lines += text;
  }
  return lines;
}

}  // namespace

std::string bench_surface(const BenchSubject &subject, Json *entry) {
  const BenchOptions &bench = subject.options.bench;
  Deliveries deliveries = bench.deliveries;
  if (deliveries == Deliveries::kDefault)
    deliveries = subject.backend == QSES_BACKEND_CUDA ? Deliveries::kBoth : Deliveries::kHost;
  std::string times, stages;
  Json places = Json::object();
  qses_mesh mesh = {};
  qses_report report = {};
  const std::pair<const char *, qses_delivery> all[] = {{"device", QSES_DELIVERY_DEVICE}, {"host", QSES_DELIVERY_HOST}};
  for (const auto &[name, delivery] : all) {
    if (deliveries == (delivery == QSES_DELIVERY_HOST ? Deliveries::kDevice : Deliveries::kHost)) continue;
    const Delivered found = deliver(subject, delivery);
    mesh = found.mesh;
    report = found.report;
    places[name] = times_json(found, subject.backend);
    char text[60];
    std::snprintf(text, sizeof text, ", %s %.3f ms", name, median(found.times));
    times += text;
    stages += stage_lines(name, found.stages);
  }
  (*entry)["vertices"] = mesh.vertex_count;
  (*entry)["triangles"] = mesh.triangle_count;
  if (bench.measure) {
    (*entry)["area"] = report.area;
    (*entry)["volume"] = report.volume;
  }
  entry->update(places);
  char text[240];
  std::snprintf(text, sizeof text, "%u triangles, %.2f MB, %s%s (median of %u)", mesh.triangle_count,
                1e-6 * static_cast<double>(report.mesh_bytes), name_of(subject.backend), times.c_str(), bench.repeat);
  return text + stages;
}

}  // namespace quickses::cli
