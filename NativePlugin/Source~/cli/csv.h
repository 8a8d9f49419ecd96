// SPDX-License-Identifier: MIT
// Fields of CSV files.
#pragma once

#include <cstdio>
#include <string>

namespace quickses::cli {

// In quotes where it needs them, and on one line.
inline std::string csv_field(const std::string &text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c == '\n' || c == '\r' ? ' ' : c;
  }
  return field + '"';
}

inline std::string csv_number(double value, int digits) {
  char text[400];  // the largest double has 309 digits before the point
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace quickses::cli
