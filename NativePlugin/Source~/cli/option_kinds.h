// SPDX-License-Identifier: MIT
// Kinds of options: names out of a list, numbers within bounds, sizes of memory, colours. Whatever else is given is
// refused with a sentence that names the flag.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <string>

#include "cli/exit_code.h"
#include "cli/options.h"

namespace quickses::cli {

template <typename Enum>
const char *find_name(const std::map<std::string, Enum> &names, Enum value) {
  for (const auto &entry : names)
    if (entry.second == value) return entry.first.c_str();
  return "unknown";
}

// "auto|cuda|cpu"
template <typename Enum>
std::string joined_names(const std::map<std::string, Enum> &names, const char *separator) {
  std::string list;
  for (const auto &entry : names) list += (list.empty() ? "" : separator) + entry.first;
  return list;
}

// Throws Failure (kUsage) with the list of what there is.
template <typename Enum>
Enum look_up(const std::string &flag, const std::map<std::string, Enum> &names, const std::string &text) {
  const auto found = names.find(text);
  if (found != names.end()) return found->second;
  throw Failure(kUsage, flag + ": '" + text + "' is not one of " + joined_names(names, ", "));
}

template <typename Enum>
void add_choice(CLI::App *app, const char *flag, Enum &value, const std::map<std::string, Enum> &names,
                const char *help) {
  app->add_option_function<std::string>(
         flag, [&value, &names, flag](const std::string &text) { value = look_up(flag, names, text); }, help)
      ->type_name(joined_names(names, "|"))
      ->default_str(find_name(names, value));
}

void add_switch(CLI::App *app, const char *flag, Switch &value, const char *help);

// flags as CLI11 wants them; shown: in messages. is_length: in angstrom, else a factor.
void add_number(CLI::App *app, const char *flags, const char *shown, double &value, double low, double high,
                const char *help, bool is_length = true);
void add_count(CLI::App *app, const char *flags, const char *shown, unsigned &value, int low, int high,
               const char *help);
void add_size(CLI::App *app, const char *flag, uint64_t &value, const char *help);

// "512M" and the like in bytes: K, M, G, T are powers of 1024. False where the text is no such size or none at all.
bool parse_size(const std::string &text, uint64_t &bytes);

// "#C08000". False where the text is no colour.
bool parse_color(const std::string &text, io::Rgba &color);

}  // namespace quickses::cli
