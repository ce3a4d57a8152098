// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <iterator>

#include "guide/guide.hpp"

namespace anticrack::guide {
namespace {

const auto has_name = [](const CLI::App* command) { return !command->get_name().empty(); };

}  // namespace

std::vector<const CLI::App*> commands_of(const CLI::App& command) {
  return command.get_subcommands(has_name);
}

const CLI::App* command_of(const CLI::App& command, const std::string& name) {
  const auto all = commands_of(command);
  const auto found = std::ranges::find(all, name, &CLI::App::get_name);
  return found == all.end() ? nullptr : *found;
}

std::vector<const CLI::App*> with_all_below(const CLI::App& command) {
  std::vector<const CLI::App*> result{&command};
  for (const CLI::App* below : commands_of(command))
    std::ranges::copy(with_all_below(*below), std::back_inserter(result));
  return result;
}

std::string path_of(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent == nullptr ? command.get_name() : path_of(*parent) + " " + command.get_name();
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> options = command.get_options();
  for (const CLI::App* group : command.get_subcommands(std::not_fn(has_name)))
    for (const CLI::Option* option : group->get_options())
      if (command.get_option_no_throw(option->get_name()) == option) options.push_back(option);
  return options;
}

const CLI::Option* option_of(const CLI::App& command, const std::string& name) {
  const CLI::App* program = &command;
  while (program->get_parent() != nullptr) program = program->get_parent();
  const CLI::Option* const own = command.get_option_no_throw(name);
  return own != nullptr ? own : program->get_option_no_throw(name);
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string type_of(const CLI::Option& option) {
  return option.get_items_expected_max() == 0 ? "" : option.get_type_name();
}

}  // namespace anticrack::guide
