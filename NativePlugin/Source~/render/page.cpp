// SPDX-License-Identifier: MIT
// The file of a page.
#include "render/page.h"

#include <algorithm>
#include <cstdio>

#include "io/error.h"
#include "render/look.h"
#include "render/page_parts.h"
#include "render/page_text.h"

namespace quickses::render {
namespace {

const char kThreeLicense[] =
    "three.js, Copyright 2010-2019 three.js authors. The MIT License\n"
    "Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated\n"
    "documentation files (the \"Software\"), to deal in the Software without restriction, including without "
    "limitation\n"
    "the rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and\n"
    "to permit persons to whom the Software is furnished to do so, subject to the following conditions:\n"
    "The above copyright notice and this permission notice shall be included in all copies or substantial portions of\n"
    "the Software.\n"
    "THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED\n"
    "TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL "
    "THE\n"
    "AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF\n"
    "CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER "
    "DEALINGS\n"
    "IN THE SOFTWARE.\n";

// "13,505"
std::string grouped(size_t number) {
  std::string digits = std::to_string(number);
  for (size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

std::string script(std::string_view text) { return "<script>\n" + std::string(text) + "\n</script>\n"; }

std::string page_end() { return script(kPageScript) + "</body>\n</html>\n"; }

}  // namespace

void check_pages_can_be_made() {
  if (kThree.empty() || kTrackballControls.empty())
    io::fail_usage("this build of the program can't make pages (.html): three.js was not there (libjs-three)");
}

Page::Page(const std::string &path, const PageSettings &settings, uint64_t most_bytes)
    : file_(path), most_bytes_(most_bytes) {
  check_pages_can_be_made();
  const Camera &camera = settings.camera;
  char background[16];
  std::snprintf(background, sizeof background, "#%02x%02x%02x", settings.background[0], settings.background[1],
                settings.background[2]);
  const float light = 0.2126f * linear_of(settings.background[0]) + 0.7152f * linear_of(settings.background[1]) +
                      0.0722f * linear_of(settings.background[2]);
  const std::string title = escaped(settings.title);
  const glm::vec2 filled = camera.half / camera.enlargement();
  write(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"QuickSES\">\n<title>" +
      title + "</title>\n<style>\n" + std::string(kPageStyle) + "</style>\n</head>\n<body class=\"" +
      (light > 0.18f ? "light" : "dark") + "\" style=\"background:" + background + "\">\n");
  write("<div id=\"view\" data-toward=\"" + numbers(camera.toward) + "\" data-up=\"" + numbers(camera.up) +
        "\" data-distance=\"" + numbers({camera.distance}) + "\" data-half=\"" + numbers({filled.x, filled.y}) +
        "\" data-background=\"" + background + "\" data-lamp=\"" + numbers(kLamp) + "\"></div>\n");
  write(
      "<div id=\"caption\" title=\"Drag turns, wheel or two fingers zoom, right button moves, double click resets\">" +
      title + " <small>" + grouped(settings.atom_count) +
      " atoms, <span id=\"triangles\"></span> triangles</small></div>\n"
      "<div id=\"player\" hidden><button id=\"play\" aria-label=\"Play\">\u25b6</button>"
      "<input id=\"slider\" type=\"range\" min=\"0\" value=\"0\" aria-label=\"Frame\"><span "
      "id=\"label\"></span></div>\n"
      "<div id=\"trouble\" hidden></div>\n<noscript>This page shows a surface by a script.</noscript>\n");
  write(std::string("<!--\n") + kThreeLicense + "-->\n" + script(kThree) + script(kTrackballControls));
}

void Page::write(const std::string &text) {
  size_ += text.size();
  file_.write(text);
}

void Page::add(const std::string &mesh, size_t more) {
  const double size = static_cast<double>(mesh.size());
  const double room = static_cast<double>(most_bytes_) - static_cast<double>(size_ + page_end().size());
  if (room < size * (1 + 0.9 * static_cast<double>(more))) {
    const size_t count = mesh_count_ + 1 + more;
    const auto fitting = mesh_count_ + static_cast<size_t>(std::max(0.0, room / size));
    io::fail_output("the page '" + file_.path() + "' would have more than " + std::to_string(most_bytes_ / 1'000'000) +
                    " MB, which browsers don't bear: " +
                    (count > 1 ? "about " + std::to_string(fitting) + " of its " + std::to_string(count) +
                                     " surfaces fit; a larger --spacing makes them smaller"
                               : "a larger --spacing makes it smaller"));
  }
  write(mesh);
  ++mesh_count_;
}

void Page::finish() {
  write(page_end());
  file_.commit();
}

}  // namespace quickses::render
