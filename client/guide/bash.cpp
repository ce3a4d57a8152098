// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "guide/shells.hpp"

namespace anticrack::guide {
namespace {

/// A branch of `case`.
void add_case(std::ostream& out, const std::string& patterns, const std::string& action) {
  out << "    " << patterns << ") " << action << " ;;\n";
}

std::string bash_value(const Value& value) {
  switch (value.kind) {
    case Value::Kind::file:
      return "compopt -o filenames; COMPREPLY=($(compgen -f -- \"$current\"))";
    case Value::Kind::folder:
      return "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$current\"))";
    case Value::Kind::word:
      return "COMPREPLY=($(compgen -W " + shell_word(joined(value.words)) + " -- \"$current\"))";
    case Value::Kind::none:
    case Value::Kind::text:
      break;
  }
  return ":";  // neither a command nor a file
}

}  // namespace

std::string bash_script(const Command& program) {
  const std::vector<const Command*> commands = with_all_below(program);
  const std::string name = program.name, function = "_" + name;
  std::ostringstream out;
  out << "# bash completion of " << name << ": source <(" << name << " completion bash)\n"
      << function << "() {\n"
      << "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} path= i\n"
      << "  COMPREPLY=()\n"
      << "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      << "    case \"$path:${COMP_WORDS[i]}\" in\n";
  std::vector<std::string> known, valued;
  for (const Command* command : commands)
    for (const Command& below : command->commands)
      known.push_back(shell_word(command->path + ":" + below.name));
  for (const std::string& option : with_value(program)) valued.push_back("*:" + option);
  out << "      " << joined(valued, " | ") << ") ((++i)) ;;\n"
      << "      " << joined(known, " | ") << ") path=\"${path:+$path }${COMP_WORDS[i]}\" ;;\n"
      << "    esac\n"
      << "  done\n"
      << "  case \"$path:$before\" in\n";
  for (const Command* command : commands) {
    for (const Option& option : options_of(*command, program)) {
      if (option.value.kind == Value::Kind::none) continue;
      std::vector<std::string> patterns;
      for (const std::string& of_option : option.names)
        patterns.push_back(shell_word(command->path + ":" + of_option));
      add_case(out, joined(patterns, " | "), bash_value(option.value) + "; return");
    }
  }
  out << "  esac\n"
      << "  case \"$path:$current\" in\n";
  for (const Command* command : commands) {
    std::string words;
    for (const Option& option : options_of(*command, program))
      for (const std::string& of_option : option.names) words += of_option + " ";
    add_case(out, shell_word(command->path + ":") + "-*",
             "COMPREPLY=($(compgen -W " + shell_word(words) + " -- \"$current\"))");
  }
  for (const Command* command : commands) {
    Value value = first_positional(*command);
    if (!command->commands.empty()) {
      value.kind = Value::Kind::word;
      value.words.clear();
      for (const Command& below : command->commands) value.words.push_back(below.name);
    }
    add_case(out, shell_word(command->path + ":") + "*", bash_value(value));
  }
  out << "  esac\n"
      << "}\n"
      << "complete -F " << function << ' ' << name << '\n';
  return out.str();
}

}  // namespace anticrack::guide
