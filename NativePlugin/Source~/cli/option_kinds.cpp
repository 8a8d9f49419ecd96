// SPDX-License-Identifier: MIT
// Kinds of options.
#include "cli/option_kinds.h"

#include <cstdio>

#include "io/text.h"

namespace quickses::cli {

void add_switch(CLI::App *app, const char *flag, Switch &value, const char *help) {
  static const std::map<std::string, Switch> kSwitches = {{"on", Switch::kOn}, {"off", Switch::kOff}};
  app->add_option_function<std::string>(
         flag, [&value, flag](const std::string &text) { value = look_up(flag, kSwitches, text); }, help)
      ->type_name("on|off");
}

void add_number(CLI::App *app, const char *flags, const char *shown, double &value, double low, double high,
                const char *help, bool is_length) {
  app->add_option_function<std::string>(
         flags,
         [&value, shown, low, high, is_length](const std::string &text) {
           double number = 0;
           if (!io::parse_number(text, number))
             throw Failure(kUsage, std::string(shown) + ": '" + text + "' is no number");
           if (number < low || number > high) {
             char range[96];
             std::snprintf(range, sizeof range, " is not between %g and %g%s", low, high, is_length ? " angstrom" : "");
             throw Failure(kUsage, std::string(shown) + ": " + text + range);
           }
           value = number;
         },
         help)
      ->type_name(is_length ? "A" : "F")
      ->default_str(CLI::detail::to_string(value));
}

void add_count(CLI::App *app, const char *flags, const char *shown, unsigned &value, int low, int high,
               const char *help) {
  app->add_option_function<std::string>(
         flags,
         [&value, shown, low, high](const std::string &text) {
           int number = 0;
           if (!io::parse_integer(text, number) || number < low || number > high)
             throw Failure(kUsage, std::string(shown) + ": '" + text + "' is no whole number between " +
                                       std::to_string(low) + " and " + std::to_string(high));
           value = static_cast<unsigned>(number);
         },
         help)
      ->type_name("N");
}

void add_size(CLI::App *app, const char *flag, uint64_t &value, const char *help) {
  app->add_option_function<std::string>(
         flag,
         [&value, flag](const std::string &text) {
           if (!parse_size(text, value))
             throw Failure(kUsage, std::string(flag) + ": '" + text + "' is no size such as 512M or 2G");
         },
         help)
      ->type_name("SIZE");
}

bool parse_size(const std::string &text, uint64_t &bytes) {
  size_t digits = 0;
  while (digits < text.size() && (io::is_digit(text[digits]) || text[digits] == '.')) ++digits;
  double number = 0;
  if (!io::parse_number(text.substr(0, digits), number)) return false;
  std::string unit = io::raised(text.substr(digits));
  if (unit.size() > 1 && unit.back() == 'B') unit.pop_back();
  if (unit.size() > 1 && unit.back() == 'I') unit.pop_back();
  if (unit == "B") unit.clear();
  const size_t power = unit.empty() ? 0 : unit.size() > 1 ? std::string::npos : std::string("KMGT").find(unit[0]) + 1;
  if (power > 4 || (!unit.empty() && power == 0)) return false;
  const double size = std::ldexp(number, static_cast<int>(10 * power));
  if (!(size >= 1) || size > 9e18) return false;
  bytes = static_cast<uint64_t>(size);
  return true;
}

bool parse_color(const std::string &text, io::Rgba &color) {
  constexpr size_t kSize = 7;
  if (text.size() != kSize || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != text.npos)
    return false;
  const unsigned long rgb = std::stoul(text.substr(1), nullptr, 16);
  color = {static_cast<uint8_t>(rgb >> 16), static_cast<uint8_t>(rgb >> 8), static_cast<uint8_t>(rgb), 255};
  return true;
}

}  // namespace quickses::cli
