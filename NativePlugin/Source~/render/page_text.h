// SPDX-License-Identifier: MIT
// Text of pages.
#pragma once

#include <cstdio>
#include <glm/glm.hpp>
#include <initializer_list>
#include <string>

namespace quickses::render {

inline std::string numbers(std::initializer_list<float> values) {
  std::string text;
  for (const float value : values) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%s%.9g", text.empty() ? "" : " ", static_cast<double>(value));
    text += digits;
  }
  return text;
}

inline std::string numbers(glm::vec3 v) { return numbers({v.x, v.y, v.z}); }

// Names of files may be anything, and must stay text.
inline std::string escaped(const std::string &text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else if (c == '\'')
      safe += "&#39;";
    else
      safe += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return safe;
}

}  // namespace quickses::render
