// SPDX-License-Identifier: MIT
// The JSON reports of the program.
#include "cli/report.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "cli/shown_output.h"
#include "io/atomic_file.h"

namespace quickses::cli {
namespace {

// The largest area first.
Json components_json(const qses_mesh &mesh) {
  std::vector<uint32_t> order(mesh.component_count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return mesh.components[a].area > mesh.components[b].area; });
  Json list = Json::array();
  for (const uint32_t k : order) list.push_back(component_json(k, mesh.components[k]));
  return list;
}

Json vector_json(const float *v) { return {v[0], v[1], v[2]}; }
Json bounds_json(const float *min, const float *max) { return {vector_json(min), vector_json(max)}; }

}  // namespace

Json failed_input_json(const Options &options, const Failure &failure) {
  return {{"schema", kReportSchema}, {"input", options.input}, {"error", failure.what()}};
}

Json settings_json(const ComputeOptions &options) {
  Json json = {{"surface", name_of(options.surface)},
               {"method", name_of(options.method)},
               {"probe", options.probe},
               {"spacing", options.spacing},
               {"steps", options.steps},
               {"creases", options.creases == Switch::kOn}};
  if (options.surface == QSES_SURFACE_GAUSSIAN) {
    json["radius_scale"] = options.radius_scale;
    json["isovalue"] = options.isovalue;
  }
  if (options.occlusion == Switch::kOn) json["occlusion"] = true;
  if (options.slice != 0) json["slice"] = options.slice;
  if (options.memory != 0) json["memory"] = options.memory;
  if (options.threads != 0) json["threads"] = options.threads;
  json["radii"] = options.radii;
  return json;
}

const char *name_of(qses_measured_by measured_by) {
  switch (measured_by) {
    case QSES_MEASURED_BY_ATOMS:
      return "atoms";
    case QSES_MEASURED_BY_NORMALS:
      return "normals";
    case QSES_MEASURED_BY_TRIANGLES:
      return "triangles";
    case QSES_MEASURED_BY_NOTHING:
      break;
  }
  return "nothing";
}

Json report_head_json(const Options &options, const io::Structure &structure, const Engine &engine) {
  Json json;
  json["schema"] = kReportSchema;
  json["version"] = qses_version();
  json["input"] = options.input;
  if (!options.output.empty()) json["output"] = io::is_standard_output(options.output) ? "-" : options.output;
  json["model"] = structure.model;
  json["atoms"] = structure.atoms.size();
  json["settings"] = settings_json(options.compute);
  if (has_outer_only(options)) json["settings"]["outer"] = true;
  json["backend"] = name_of(engine.backend());
  json["device"] = engine.device();
  return json;
}

Json measures_json(const qses_report &report) {
  Json json = {{"area", report.area}, {"volume", report.volume}, {"measured_by", name_of(report.measured_by)}};
  if (report.triangle_area > 0) {
    json["triangle_area"] = report.triangle_area;
    json["triangle_volume"] = report.triangle_volume;
  }
  return json;
}

Json memory_json(const qses_report &report, qses_backend backend) {
  Json memory = Json::object();
  if (backend == QSES_BACKEND_CUDA) memory["peak_device"] = report.work_bytes_peak;
  memory["peak_host"] = report.host_bytes_peak;
  memory["mesh"] = report.mesh_bytes;
  return memory;
}

Json component_json(uint32_t number, const qses_component &component) {
  return {{"component", number},
          {"triangles", component.triangles},
          {"area", component.area},
          {"volume", component.volume},
          {"cavity", component.is_cavity != 0},
          {"center", vector_json(component.center)},
          {"bounds", bounds_json(component.bounds_min, component.bounds_max)}};
}

Json surface_json(const Options &options, const io::Structure &structure, const Engine &engine, const qses_mesh &mesh,
                  const MeshSize &written, const qses_report &report, const Timings &timings) {
  Json json = report_head_json(options, structure, engine);
  json["settings"]["hard_edges"] = has_hard_edges(options);
  if (options.mesh.colors != MeshColors::kNone) json["settings"]["color"] = name_of(options.mesh.colors);
  if (options.mesh.sharp) json["settings"]["sharp_colors"] = true;
  if (options.mesh.center) json["settings"]["center"] = true;
  if (options.mesh.scale != 1) json["settings"]["scale"] = options.mesh.scale;
  json["mesh"] = {{"vertices", mesh.vertex_count - mesh.repeated_count},
                  {"repeated", mesh.repeated_count},
                  {"triangles", mesh.triangle_count},
                  {"closed", true},
                  {"bounds", bounds_json(mesh.bounds_min, mesh.bounds_max)}};
  if (options.mesh.sharp) json["cut"] = {{"vertices", written.vertices}, {"triangles", written.triangles}};
  json.update(measures_json(report));
  json["components"] = components_json(mesh);
  Json stages = Json::object();
  for (uint32_t i = 0; i < report.stage_count && i < QSES_MAX_STAGES; ++i)
    stages[report.stages[i].name] = report.stages[i].milliseconds;
  json["time_ms"] = {
      {"read", timings.read}, {"compute", report.compute_ms}, {"write", timings.write}, {"stages", stages}};
  json["memory"] = memory_json(report, engine.backend());
  return json;
}

std::string dump(const Json &json, bool one_line) {
  return json.dump(one_line ? -1 : 2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quickses::cli
