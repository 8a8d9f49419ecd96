// SPDX-License-Identifier: MIT
#include "cli/manual.h"

#include <algorithm>

#include "cli/help_format.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

// ---- troff

std::string escaped(const std::string &text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if (c == '\'')
      safe += "\\(aq";
    else if (c == '`')
      safe += "\\(ga";
    else
      safe += c;
  }
  return !safe.empty() && safe[0] == '.' ? "\\&" + safe : safe;
}

// Text as it is, line by line.
std::string verbatim(const std::string &text) {
  std::string lines = ".nf\n";
  std::string_view rest = text, line;
  while (io::next_line(rest, line)) lines += line.empty() ? ".sp\n" : "\\&" + escaped(std::string(line)) + "\n";
  return lines + ".fi\n";
}

std::string options_of_manual(const CLI::App &app) {
  std::string text;
  for (const std::string &group : groups_of(app)) {
    const std::vector<const CLI::Option *> options = options_of(app, group);
    if (!options.empty()) text += ".SS " + escaped(group) + "\n";
    for (const CLI::Option *option : options) {
      const std::string value = value_of(*option);
      text += ".TP\n\\fB" + escaped(names_of(*option)) + "\\fR" +
              (value.empty() ? "" : " \\fI" + escaped(value) + "\\fR") + "\n" + escaped(description_of(*option)) + "\n";
    }
  }
  return text;
}

// ---- bash

// Words among the values that a flag may have: of "auto|cuda|cpu" all, of "N|all" the last.
std::string words_of(const CLI::Option &option) {
  std::string words;
  for (const std::string &value : io::split(value_of(option), '|'))
    if (!value.empty() && std::all_of(value.begin(), value.end(), [](char c) { return c >= 'a' && c <= 'z'; }))
      words += (words.empty() ? "" : " ") + value;
  return words;
}

// Whatever else it may have.
bool takes_more_than_words(const CLI::Option &option) {
  const std::string value = value_of(option);
  return std::any_of(value.begin(), value.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
}

std::string flags_of(const CLI::App &app) {
  std::string flags;
  for (const std::string &group : groups_of(app))
    for (const CLI::Option *option : options_of(app, group))
      for (const std::string &name : option->get_lnames()) flags += (flags.empty() ? "--" : " --") + name;
  return flags;
}

// What a flag wants behind it: its words, or, where COMPREPLY stays empty, a file, which is bash's own default.
std::string values_of_command(const CLI::App &app, const std::string &command) {
  std::string cases;
  for (const CLI::Option *option : app.get_options()) {
    if (option->get_type_size() == 0 || !option->nonpositional()) continue;
    std::string pattern;
    for (const std::string &name : option->get_snames())
      pattern += (pattern.empty() ? "" : "|") + command + ":-" + name;
    for (const std::string &name : option->get_lnames())
      pattern += (pattern.empty() ? "" : "|") + command + ":--" + name;
    const std::string words = words_of(*option);
    cases += "    " + pattern + ") words='" + words + "'; takes_words=yes";
    if (!words.empty() && takes_more_than_words(*option)) cases += "; takes_files=yes";
    cases += " ;;\n";
  }
  return cases;
}

}  // namespace

std::string manual_page(const CLI::App &app, const std::string &version) {
  const std::string description = app.get_description();
  std::string_view rest = description, line;
  io::next_line(rest, line);
  std::string text = ".\\\" Made by quickses --help-man\n.TH QUICKSES 1 \"\" \"quickses " + version +
                     "\" \"User Commands\"\n.SH NAME\nquickses \\- molecular surfaces as closed triangle meshes\n" +
                     ".SH SYNOPSIS\n" + verbatim(std::string(rest.substr(std::min<size_t>(1, rest.size())))) +
                     ".SH OPTIONS\n" + options_of_manual(app);
  for (const CLI::App *command : app.get_subcommands(nullptr))
    text += ".SH COMMAND " + escaped(command->get_name()) + "\n" + escaped(command->get_description()) + ".\n" +
            options_of_manual(*command);
  return text + ".SH NOTES\n" + verbatim(app.get_footer());
}

std::string bash_completion(const CLI::App &app) {
  std::string commands, names, values = values_of_command(app, ""), flags;
  for (const CLI::App *command : app.get_subcommands(nullptr)) {
    const std::string name = command->get_name();
    names += (names.empty() ? "" : " ") + name;
    commands += (commands.empty() ? "" : "|") + name;
    values += values_of_command(*command, name);
    flags += "    " + name + ") flags='" + flags_of(*command) + "' ;;\n";
  }
  return R"(# Completion of quickses in bash. Made by quickses --help-completion
_quickses() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local command='' flags='' words='' takes_words='' takes_files=''
  # bash takes --flag=value apart.
  if [[ $current == = ]]; then
    current=''
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  case ${COMP_WORDS[1]} in
    )" + commands +
         R"() ((COMP_CWORD > 1)) && command=${COMP_WORDS[1]} ;;
  esac
  case $command:$previous in
)" + values +
         R"(  esac
  case $command in
)" + flags +
         "    *) flags='" + flags_of(app) + R"(' ;;
  esac
  COMPREPLY=()
  if [[ $takes_words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current"; [[ $takes_files ]] && compgen -f -- "$current")
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$flags" -- "$current")
  elif ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W ')" +
         names + R"(' -- "$current"; compgen -f -- "$current")
  fi
}
complete -o bashdefault -o default -F _quickses quickses
)";
}

}  // namespace quickses::cli
