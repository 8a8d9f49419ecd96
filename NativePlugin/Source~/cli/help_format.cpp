// SPDX-License-Identifier: MIT
#include "cli/help_format.h"

#include <algorithm>

#include "io/text.h"

namespace quickses::cli {
namespace {

constexpr size_t kIndent = 26, kWidth = 96;  // columns
const char kNoGroup[] = "Options";           // what CLI11 puts flags into

// The name on the left, the words on the right, below it where the name is long.
std::string entry(const std::string &name, const std::string &text) {
  std::string lines = "  " + name;
  size_t column = lines.size();
  std::vector<std::string_view> words;
  io::split_words(text, words);
  if (column + 2 > kIndent && !words.empty()) {
    lines += "\n";
    column = 0;
  }
  bool begins = true;
  for (const std::string_view word : words) {
    if (!begins && column + 1 + word.size() > kWidth) {
      lines += "\n";
      column = 0;
      begins = true;
    }
    const size_t blanks = begins ? kIndent - column : 1;
    lines.append(blanks, ' ').append(word);
    column += blanks + word.size();
    begins = false;
  }
  return lines + "\n";
}

}  // namespace

std::string names_of(const CLI::Option &option) {
  std::string names;
  for (const std::string &name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
  for (const std::string &name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
  return names.empty() ? option.get_name(true) : names;
}

std::string value_of(const CLI::Option &option) {
  return option.get_type_size() == 0 ? "" : option.get_type_name() == "TEXT" ? "FILE" : option.get_type_name();
}

std::string description_of(const CLI::Option &option) {
  const std::string standard = option.get_type_size() == 0 ? "" : option.get_default_str();
  return option.get_description() + (standard.empty() ? "" : " (default " + standard + ")");
}

std::vector<std::string> groups_of(const CLI::App &app) {
  std::vector<std::string> groups = {"Input",  "Output",     "Picture",   "Surface",
                                     "Timing", "Trajectory", "Computing", "Report"};
  for (const std::string &group : app.get_groups())
    if (!group.empty() && std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  return groups;
}

std::vector<const CLI::Option *> options_of(const CLI::App &app, const std::string &group) {
  return app.get_options(
      [&](const CLI::Option *option) { return option->get_group() == group && option->nonpositional(); });
}

void put_into_group(CLI::App *app, const char *group, std::initializer_list<const char *> flags) {
  for (const char *flag : flags)
    if (CLI::Option *option = app->get_option_no_throw(flag))
      if (option->get_group() == kNoGroup) option->group(group);
}

void put_rest_into_group(CLI::App *app, const char *group) {
  for (CLI::Option *option : app->get_options([](CLI::Option *) { return true; }))
    if (option->get_group() == kNoGroup) option->group(group);
}

std::string HelpFormat::make_option(const CLI::Option *option, bool is_positional) const {
  const std::string value = value_of(*option);
  const std::string name =
      is_positional ? option->get_name(true) : names_of(*option) + (value.empty() ? "" : " " + value);
  return entry(name, description_of(*option));
}

// Those that have no flag; the others are among the flags.
std::string HelpFormat::make_positionals(const CLI::App *app) const {
  std::string text;
  for (const CLI::Option *option : app->get_options())
    if (option->get_positional() && !option->nonpositional()) text += make_option(option, true);
  return text.empty() ? text : "\n" + text;
}

std::string HelpFormat::make_help(const CLI::App *app, std::string name, CLI::AppFormatMode mode) const {
  std::string text = make_description(app) + make_usage(app, name) + make_positionals(app);
  for (const std::string &group : groups_of(*app)) {
    const std::vector<const CLI::Option *> options = options_of(*app, group);
    if (options.empty()) continue;
    text += "\n" + group + ":\n";
    for (const CLI::Option *option : options) text += make_option(option, false);
  }
  return text + make_subcommands(app, mode) + "\n" + make_footer(app);
}

std::string HelpFormat::make_subcommand(const CLI::App *command) const {
  return entry(command->get_name(), command->get_description());
}

}  // namespace quickses::cli
