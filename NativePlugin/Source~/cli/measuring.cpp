// SPDX-License-Identifier: MIT
// Numbers of surfaces, without their meshes.
#include "cli/measuring.h"

#include <algorithm>

#include "cli/csv.h"

namespace quickses::cli {

Measurement measure_surfaces(Engine &engine, const Options &options) {
  Measurement found;
  for (const qses_surface surface : options.measured) {
    qses_settings settings = settings_of(options.compute);
    settings.surface = surface;
    settings.delivery = QSES_DELIVERY_NONE;
    settings.atom_areas = options.wants_areas();
    const qses_mesh mesh = engine.compute(settings);
    found.surfaces.push_back({surface, engine.report()});
    found.milliseconds += found.surfaces.back().report.compute_ms;
    for (AtomAreas &areas : areas_of(surface, mesh)) found.areas.push_back(std::move(areas));
  }
  return found;
}

Json measurement_json(const Options &options, const io::Structure &structure, const Engine &engine,
                      const Measurement &measurement, const Timings &timings) {
  Json json = report_head_json(options, structure, engine);
  Json &settings = json["settings"];
  settings.erase("surface");
  settings.erase("method");
  if (std::find(options.measured.begin(), options.measured.end(), QSES_SURFACE_SES) == options.measured.end())
    for (const char *name : {"spacing", "steps", "slice"}) settings.erase(name);  // of a mesh that is not made
  Json list = Json::array();
  for (const SurfaceNumbers &numbers : measurement.surfaces) {
    Json entry = {{"surface", name_of(numbers.surface)}};
    entry.update(measures_json(numbers.report));
    list.push_back(entry);
  }
  json["surfaces"] = list;
  json["time_ms"] = {{"read", timings.read}, {"compute", measurement.milliseconds}};
  return json;
}

std::string measurement_csv_header(const std::vector<qses_surface> &surfaces) {
  std::string header = "frame";
  for (const qses_surface surface : surfaces) {
    const std::string name = name_of(surface);
    header += "," + name + "_area_A2," + name + "_volume_A3";
  }
  return header + ",time_ps,error\n";
}

std::string measurement_csv_row(uint64_t frame, std::optional<double> time, const Measurement &measurement) {
  std::string row = std::to_string(frame);
  for (const SurfaceNumbers &numbers : measurement.surfaces)
    row += "," + csv_number(numbers.report.area, 4) + "," + csv_number(numbers.report.volume, 4);
  return row + "," + (time ? csv_number(*time, 3) : "") + ",\n";
}

}  // namespace quickses::cli
