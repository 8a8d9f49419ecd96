// SPDX-License-Identifier: MIT
#include "cli/suggestions.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "cli/exit_code.h"
#include "io/file_path.h"
#include "io/mesh_writer.h"
#include "io/nearest_word.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

// Without dashes.
std::vector<std::string> long_flags(const CLI::App &command) {
  std::vector<std::string> flags;
  for (const CLI::Option *option : command.get_options())
    flags.insert(flags.end(), option->get_lnames().begin(), option->get_lnames().end());
  return flags;
}

// "spacing" of "-spacing" and "-spacing=0.3"; "" where it is something else, as -v0.3 is.
std::string word_behind_dash(const std::string &argument) {
  if (argument.size() < 4 || argument[0] != '-' || !io::is_letter(argument[1]) || !io::is_letter(argument[2]))
    return "";
  return argument.substr(1, argument.find('=') - 1);
}

std::string help_of(const CLI::App &command) {
  const CLI::App *parent = command.get_parent();
  return (parent ? parent->get_name() + " " : "") + command.get_name() + " --help";
}

// "" if the word is like no command.
std::string explain_command(const CLI::App &command, const std::string &word) {
  std::vector<std::string> names;
  for (const CLI::App *other : command.get_subcommands(nullptr)) names.push_back(other->get_name());
  const std::string nearest = io::nearest_word(word, names);
  return nearest.empty() ? "" : "'" + word + "' is no command; did you mean " + nearest + "?";
}

}  // namespace

void check_command(const CLI::App &app, const std::string &first_input) {
  std::error_code no_matter;
  if (std::filesystem::exists(io::path_of(first_input), no_matter)) return;
  const std::string explained = explain_command(app, first_input);
  if (!explained.empty()) throw Failure(kUsage, explained);
}

const CLI::App &command_of(const CLI::App &app, const std::vector<std::string> &arguments) {
  for (const CLI::App *command : app.get_subcommands(nullptr))
    if (!arguments.empty() && command->get_name() == arguments[0]) return *command;
  return app;
}

void check_dashes(const CLI::App &command, const std::vector<std::string> &arguments) {
  const std::vector<std::string> flags = long_flags(command);
  for (const std::string &argument : arguments) {
    const std::string word = word_behind_dash(argument);
    if (!word.empty() && std::find(flags.begin(), flags.end(), word) != flags.end())
      throw Failure(kUsage,
                    "-" + word + ": flags of more than one letter have two dashes; did you mean --" + word + "?");
  }
}

std::string suggest_dashes(const CLI::App &command, const std::vector<std::string> &arguments) {
  for (const std::string &argument : arguments) {
    const std::string nearest = io::nearest_word(word_behind_dash(argument), long_flags(command));
    if (!nearest.empty()) return "; did you mean --" + nearest + "?";
  }
  return "";
}

std::string explain_extra(const CLI::App &command, const std::vector<std::string> &arguments,
                          const std::string &extra) {
  if (extra.size() > 1 && extra[0] == '-') {
    const std::string flag = extra.substr(0, extra.find('='));
    const std::string word = flag.substr(std::min(flag.find_first_not_of('-'), flag.size()));
    const std::string nearest = io::nearest_word(word, long_flags(command));
    return flag + ": there is no such flag; " +
           (nearest.empty() ? "see " + help_of(command) : "did you mean --" + nearest + "?");
  }
  const std::string explained = explain_command(command, arguments[0]);
  if (!explained.empty()) return explained;
  return "'" + extra + "': one INPUT was given already; " +
         (io::find_mesh_format(extra) ? "did you mean -o " + extra + "?" : "see " + help_of(command));
}

std::string explain_count(const std::string &sentence, const std::vector<std::string> &arguments) {
  const size_t no_value = sentence.find(" was given a disallowed flag override");
  if (no_value != std::string::npos) {
    const std::string flag = "--" + sentence.substr(0, no_value), before = flag + "=";
    for (const std::string &argument : arguments)
      if (argument.compare(0, before.size(), before) == 0)
        return flag + ": '" + argument.substr(before.size()) + "' is given, and it takes no value";
    return flag + ": it takes no value";
  }
  const std::string flag = sentence.substr(0, sentence.find(':'));
  const std::string too_often = ": At Most 1 required but received ", before_value = ": 1 required ",
                    missing = " missing";
  if (sentence.compare(flag.size(), too_often.size(), too_often) == 0)
    return flag + ": it is given " + sentence.substr(flag.size() + too_often.size()) +
           " times, and can be given only once";
  const size_t value = flag.size() + before_value.size(), rest = value + missing.size();
  if (sentence.compare(flag.size(), before_value.size(), before_value) == 0 && sentence.size() > rest)
    return flag + ": its value is missing: " + flag + " " + sentence.substr(value, sentence.size() - rest);
  return sentence;
}

}  // namespace quickses::cli
