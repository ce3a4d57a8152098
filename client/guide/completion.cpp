// SPDX-License-Identifier: GPL-3.0-or-later
#include "guide/completion.hpp"
#include <algorithm>

#include "guide/shells.hpp"

namespace anticrack::guide {

std::string shell_word(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::vector<std::string> with_value(const Command& program) {
  std::vector<std::string> result;
  for (const Command* command : with_all_below(program)) {
    for (const Option& option : command->options)
      if (option.value.kind != Value::Kind::none)
        result.insert(result.end(), option.names.begin(), option.names.end());
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

Value first_positional(const Command& command) {
  return command.positionals.empty() ? Value{} : command.positionals.front().value;
}

std::vector<Option> options_of(const Command& command, const Command& program) {
  std::vector<Option> result = command.options;
  if (&command != &program) {
    for (const Option& option : program.options) {
      const auto same = [&](const Option& other) { return other.names == option.names; };
      if (std::none_of(result.begin(), result.end(), same))  // --help is each one's own
        result.push_back(option);
    }
  }
  return result;
}

std::string completion_script(const CLI::App& app, Shell shell) {
  const Command program = command_tree(app);
  switch (shell) {
    case Shell::bash:
      return bash_script(program);
    case Shell::zsh:
      return zsh_script(program);
    case Shell::fish:
      break;
  }
  return fish_script(program);
}

}  // namespace anticrack::guide
