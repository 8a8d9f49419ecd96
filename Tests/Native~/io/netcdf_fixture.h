// SPDX-License-Identifier: MIT
// Small netCDF files of AMBER that the tests write themselves, by code that shares nothing with the reader.
#pragma once

#include "io/trajectory_fixture.h"

namespace quickses::io {

struct NetcdfWriter {
  // Frames as records; as many as a dimension says; one frame without that dimension (a restart file).
  enum Layout { kRecords, kFixed, kRestart } layout = kRecords;
  char version = 2;
  bool is_double = false;  // coordinates and time; boxes always are
  bool is_open = false;    // the number of records is not told
  bool has_box = false, has_time = false;
  bool is_time_last = false;
  bool has_odd = false;  // variables whose values have to be filled up, before and behind coordinates
  std::vector<double> cell = {30, 40, 50, 90, 90, 90};
  double scale = 1;                // an attribute unless it is 1
  int scale_count = 1;             // numbers of that attribute, all the same
  std::string units = "angstrom";  // of coordinates; empty: no attribute
  std::string time_unit = "picosecond";
  std::string name = "coordinates";

  // Where each frame ends, of the file written last.
  mutable std::vector<size_t> ends;

  std::string file(const std::vector<Positions> &frames) const {
    const std::vector<Variable> variables = variables_of(frames);
    const size_t frame_count = frames.size();
    std::vector<uint64_t> begins(variables.size());
    uint64_t at = header(frames, variables, begins).size();  // as long as it is going to be
    for (size_t v = 0; v < variables.size(); ++v)
      if (!variables[v].is_record(layout)) {
        begins[v] = at;
        for (const std::string &piece : variables[v].pieces) at += piece.size();
        at = (at + 3) / 4 * 4;
      }
    for (size_t v = 0; v < variables.size(); ++v)
      if (variables[v].is_record(layout)) {
        begins[v] = at;
        at += filled(variables[v].pieces[0]).size();
      }
    std::string bytes = header(frames, variables, begins);
    ends.clear();
    for (const Variable &variable : variables) {
      if (variable.is_record(layout)) continue;
      for (const std::string &piece : variable.pieces) bytes += piece;
      bytes = filled(bytes);
    }
    for (size_t k = 0; layout == kRecords && k < frame_count; ++k) {
      for (const Variable &variable : variables)
        if (variable.is_record(layout)) bytes += filled(variable.pieces[k]);
      ends.push_back(bytes.size());
    }
    return bytes;
  }

  std::string size(uint64_t n) const {
    return version == 5 ? raw_bytes(n, true) : raw_bytes(static_cast<uint32_t>(n), true);
  }

 private:
  enum Type : uint32_t { kChar = 2, kShort = 3, kFloat = 5, kDouble = 6 };
  enum Dimension { kFrame, kSpatial, kAtom, kCellSpatial, kCellAngular, kDimensionCount };

  struct Variable {
    std::string name;
    std::vector<Dimension> dimensions;
    Type type;
    std::vector<std::string> pieces;  // of each frame, or one
    std::string units;
    double scale = 1;

    bool is_record(Layout layout) const { return layout == kRecords && !dimensions.empty() && dimensions[0] == kFrame; }
  };

  static std::string u32(uint32_t n) { return raw_bytes(n, true); }
  static std::string filled(std::string bytes) {
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    return bytes;
  }
  std::string text(const std::string &text) const { return size(text.size()) + filled(text); }
  std::string text_attribute(const std::string &key, const std::string &value) const {
    return text(key) + u32(kChar) + text(value);
  }
  std::string real(double x, bool wide) const {
    return wide ? raw_bytes(x, true) : raw_bytes(static_cast<float>(x), true);
  }

  std::vector<Variable> variables_of(const std::vector<Positions> &frames) const {
    std::vector<Variable> all = {{"spatial", {kSpatial}, kChar, {"xyz"}, "", 1}};
    const auto add = [&](const char *key, std::vector<Dimension> dimensions, Type type,
                         const std::string &unit) -> Variable & {
      if (layout != kRestart) dimensions.insert(dimensions.begin(), kFrame);
      all.push_back({key, dimensions, type, {}, unit, 1});
      return all.back();
    };
    const Type type = is_double ? kDouble : kFloat;
    const auto each = [&](Variable &variable, auto &&piece) {
      for (size_t k = 0; k < frames.size(); ++k) variable.pieces.push_back(piece(k));
    };
    if (has_odd) each(add("letters", {kSpatial}, kChar, ""), [](size_t) { return std::string("abc"); });
    const auto add_time = [&] {
      each(add("time", {}, type, time_unit), [&](size_t k) { return real(2.5 * static_cast<double>(k), is_double); });
    };
    if (has_time && !is_time_last) add_time();
    Variable &coordinates = add(name.c_str(), {kAtom, kSpatial}, type, units);
    coordinates.scale = scale;
    each(coordinates, [&](size_t k) {
      std::string bytes;
      for (float x : frames[k]) bytes += real(static_cast<double>(x) / scale, is_double);
      return bytes;
    });
    if (has_odd) each(add("numbers", {kSpatial}, kShort, ""), [](size_t) { return std::string("123456"); });
    if (has_box) {
      each(add("cell_lengths", {kCellSpatial}, kDouble, "angstrom"),
           [&](size_t) { return real(cell[0], true) + real(cell[1], true) + real(cell[2], true); });
      each(add("cell_angles", {kCellAngular}, kDouble, "degree"),
           [&](size_t) { return real(cell[3], true) + real(cell[4], true) + real(cell[5], true); });
    }
    if (has_time && is_time_last) add_time();
    return all;
  }

  std::string header(const std::vector<Positions> &frames, const std::vector<Variable> &variables,
                     const std::vector<uint64_t> &begins) const {
    const uint64_t frame_count = layout == kRecords ? 0 : frames.size();
    const std::pair<const char *, uint64_t> dimensions[kDimensionCount] = {{"frame", frame_count},
                                                                           {"spatial", 3},
                                                                           {"atom", frames[0].size() / 3},
                                                                           {"cell_spatial", 3},
                                                                           {"cell_angular", 3}};
    std::string bytes = std::string("CDF") + version;
    bytes += is_open ? std::string(version == 5 ? 8 : 4, '\xff') : size(layout == kRecords ? frames.size() : 0);
    bytes += u32(10) + size(kDimensionCount);
    for (const auto &[key, length] : dimensions) bytes += text(key) + size(length);
    bytes += u32(12) + size(2) + text_attribute("Conventions", "AMBER") + text_attribute("ConventionVersion", "1.0");
    bytes += u32(11) + size(variables.size());
    for (size_t v = 0; v < variables.size(); ++v) {
      const Variable &variable = variables[v];
      bytes += text(variable.name) + size(variable.dimensions.size());
      for (const Dimension dimension : variable.dimensions) bytes += size(dimension);
      const uint64_t attributes = (variable.units.empty() ? 0u : 1u) + (variable.scale == 1 ? 0u : 1u);
      bytes += u32(attributes == 0 ? 0 : 12) + size(attributes);
      if (!variable.units.empty()) bytes += text_attribute("units", variable.units);
      if (variable.scale != 1) bytes += text("scale_factor") + u32(kDouble) + size(static_cast<uint64_t>(scale_count));
      for (int n = 0; variable.scale != 1 && n < scale_count; ++n) bytes += raw_bytes(variable.scale, true);
      bytes += u32(variable.type) + size(filled(variable.pieces[0]).size());
      bytes += version == 1 ? u32(static_cast<uint32_t>(begins[v])) : raw_bytes(begins[v], true);
    }
    return bytes;
  }
};

}  // namespace quickses::io
