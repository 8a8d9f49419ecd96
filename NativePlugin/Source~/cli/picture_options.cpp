// SPDX-License-Identifier: MIT
// The flags of pictures and pages.
#include "cli/picture_options.h"

#include <algorithm>
#include <cmath>

#include "cli/exit_code.h"
#include "cli/help_format.h"
#include "cli/option_kinds.h"
#include "cli/shown_output.h"
#include "io/text.h"
#include "render/page.h"

namespace quickses::cli {
namespace {

constexpr int kMostPixels = 16384;  // of a side

void read_size(const std::string &text, PictureOptions &picture) {
  const size_t cross = text.find('x');
  int width = 0, height = 0;
  if (cross == std::string::npos || !io::parse_integer(text.substr(0, cross), width) ||
      !io::parse_integer(text.substr(cross + 1), height) || width < 1 || height < 1 || width > kMostPixels ||
      height > kMostPixels)
    throw Failure(kUsage, "--size: '" + text + "' is no size such as 1024x768, of at most " +
                              std::to_string(kMostPixels) + " pixels each way");
  picture.width = width, picture.height = height;
}

void read_background(const std::string &text, PictureOptions &picture) {
  if (text == "transparent")
    picture.background = {255, 255, 255, 0};
  else if (!parse_color(text, picture.background))
    throw Failure(kUsage, "--background: '" + text + "' is neither transparent nor a colour #RRGGBB, as #C08000");
}

// "1,0,2.5" with as many finite numbers as there are.
template <size_t kCount>
bool parse_numbers(const std::string &text, std::array<double, kCount> &numbers) {
  const std::vector<std::string> parts = io::split(text, ',');
  if (parts.size() != kCount) return false;
  for (size_t k = 0; k < kCount; ++k)
    if (!io::parse_number(parts[k], numbers[k])) return false;
  return true;
}

// "-y", "0,1,1"
std::array<double, 3> read_direction(const std::string &flag, const std::string &text) {
  std::array<double, 3> direction = {0, 0, 0};
  const bool is_negative = text.compare(0, 1, "-") == 0;
  const std::string axis = text.substr(is_negative ? 1 : 0);
  if (axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z') {
    direction[static_cast<size_t>(axis[0] - 'x')] = is_negative ? -1 : 1;
    return direction;
  }
  if (!parse_numbers(text, direction))
    throw Failure(kUsage, flag + ": '" + text + "' is no direction: they are written x, -z, or as 1,0,2.5");
  const double largest = std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])});
  if (largest == 0) throw Failure(kUsage, flag + ": '" + text + "' is no direction: all of it is 0");
  // Its length does not matter, but must be one that float32 can square. Powers of two change no digit.
  for (double &number : direction) number = std::ldexp(number, -std::ilogb(largest));
  return direction;
}

}  // namespace

void add_picture_options(CLI::App *app, PictureOptions &picture) {
  const auto add = [app](const char *flag, const char *help, const char *type, const auto &read) {
    return app->add_option_function<std::string>(flag, read, help)->type_name(type);
  };
  add("--size", "Of .png, in pixels", "WxH", [&picture](const std::string &text) {
    read_size(text, picture);
  })->default_str("1024x1024");
  add("--background", "Behind the surface", "transparent|#RRGGBB", [&picture](const std::string &text) {
    read_background(text, picture);
  })->default_str("#FFFFFF");
  add("--view",
      "From where it is seen: x, -z, or as 1,0,2.5. Default: so that the longest of the molecule's principal axes lies "
      "along the longer side of the picture, and the shortest points at the eye",
      "AXIS|X,Y,Z", [&picture](const std::string &text) { picture.toward = read_direction("--view", text); });
  add("--up", "The direction that points upwards. Default with --view: z, or y where it is seen along z", "AXIS|X,Y,Z",
      [&picture](const std::string &text) { picture.up = read_direction("--up", text); });
  add("--turn", "Degrees to turn it then, about the vertical and about the horizontal: 30,-15", "SPIN,NOD",
      [&picture](const std::string &text) {
        if (!parse_numbers(text, picture.turn))
          throw Failure(kUsage, "--turn: '" + text + "' is not two angles in degrees, as 30,-15");
        for (double &angle : picture.turn)
          angle = std::fmod(angle, 360);  // of whole turns float32 would keep few digits
      });
  add_number(app, "--zoom", "--zoom", picture.zoom, 0.01, 100, "Enlarge: 1 fills the picture", false);
  add_count(app, "--samples", "--samples", picture.samples, 1, 16,
            "Samples along each side of a pixel of .png, against steps; default 4");
  app->add_flag("--edges", picture.edges, "Draw the sides of the triangles, in .png");
  put_rest_into_group(app, "Picture");
}

void check_picture_options(const Options &options, const std::function<bool(const char *)> &given) {
  if (options.command != Options::Command::kSurface) return;
  const bool is_page = makes_page(options), is_shown = makes_shown(options);
  const std::string output =
      options.output.empty() ? "there is no --output (-o)" : "--output (-o) is '" + options.output + "'";
  for (const char *flag : {"--size", "--samples", "--edges"})
    if (given(flag) && (is_page || !is_shown))
      throw Failure(kUsage, std::string(flag) + ": is for pictures (.png), and " + output);
  for (const char *flag : {"--background", "--view", "--up", "--turn", "--zoom"})
    if (given(flag) && !is_shown)
      throw Failure(kUsage, std::string(flag) + ": is for pictures and pages (.png, .html), and " + output);
  if (is_page) render::check_pages_can_be_made();
}

}  // namespace quickses::cli
