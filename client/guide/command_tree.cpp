// SPDX-License-Identifier: GPL-3.0-or-later
#include "guide/guide.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>

namespace anticrack::guide {
namespace {

Value value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  const std::string type = option.get_type_name();
  if (type.rfind("FILE", 0) == 0)  // FILE.csv, too
    return {Value::Kind::file, {}};
  if (type == "DIR") return {Value::Kind::folder, {}};
  if (type == "KEY") return {Value::Kind::key, {}};
  if (type == "KEY=VALUE") return {Value::Kind::assignment, {}};
  if (type.size() > 2 && type.front() == '{' && type.back() == '}') {
    Value value{Value::Kind::word, {}};
    std::istringstream words(type.substr(1, type.size() - 2));
    for (std::string word; std::getline(words, word, ',');) value.words.push_back(word);
    return value;
  }
  return {Value::Kind::text, {}};
}

void add_options(const CLI::App& app, Command& command) {
  for (const CLI::Option* option : app.get_options()) {
    const Value value = value_of(*option);
    const std::string type = value.kind == Value::Kind::none ? "" : option->get_type_name();
    if (option->get_positional()) {
      command.positionals.push_back(
          {{option->get_name(true)}, type, option->get_description(), value});
      continue;
    }
    Option result{{}, type, option->get_description(), value};
    for (const std::string& name : option->get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) result.names.push_back("--" + name);
    const bool known = std::any_of(command.options.begin(), command.options.end(),
                                   [&](const Option& o) { return o.names == result.names; });
    if (!known)  // --help is repeated in each group of options
      command.options.push_back(std::move(result));
  }
}

Command tree_of(const CLI::App& app, const std::string& path) {
  Command command{path, app.get_name(), app.get_description(), {}, {}, {}, app.get_footer()};
  add_options(app, command);
  for (const CLI::App* below : app.get_subcommands({})) {
    if (below->get_name().empty()) {  // it is a group of options
      add_options(*below, command);
    } else {
      const std::string& name = below->get_name();
      command.commands.push_back(tree_of(*below, path.empty() ? name : path + " " + name));
    }
  }
  return command;
}

}  // namespace

Command command_tree(const CLI::App& app) { return tree_of(app, ""); }

const Option* option_of(const Command& command, const Command& program, const std::string& name) {
  for (const Command* taker : {&command, &program})
    for (const Option& option : taker->options)
      if (std::ranges::count(option.names, name) > 0) return &option;
  return nullptr;
}

std::vector<const Command*> with_all_below(const Command& command) {
  std::vector<const Command*> result{&command};
  for (const Command& below : command.commands) {
    const std::vector<const Command*> more = with_all_below(below);
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

}  // namespace anticrack::guide
