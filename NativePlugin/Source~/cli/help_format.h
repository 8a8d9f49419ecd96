// SPDX-License-Identifier: MIT
// The look of --help: flags in groups, and lines that fit a terminal.
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <vector>

namespace quickses::cli {

class HelpFormat : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option *option, bool is_positional) const override;
  std::string make_positionals(const CLI::App *app) const override;
  std::string make_help(const CLI::App *app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_subcommand(const CLI::App *command) const override;
};

// Of flags that are in no group yet: those of these names, or all.
void put_into_group(CLI::App *app, const char *group, std::initializer_list<const char *> flags);
void put_rest_into_group(CLI::App *app, const char *group);

// The groups of a command in the order they are shown in, and their flags.
std::vector<std::string> groups_of(const CLI::App &app);
std::vector<const CLI::Option *> options_of(const CLI::App &app, const std::string &group);

// "-v, --spacing", "A" and "Distance of lattice points (default 0.5)" of a flag.
std::string names_of(const CLI::Option &option);
std::string value_of(const CLI::Option &option);
std::string description_of(const CLI::Option &option);

}  // namespace quickses::cli
