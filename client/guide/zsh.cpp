// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "guide/shells.hpp"

namespace anticrack::guide {
namespace {

/// An entry of _describe.
std::string described(const std::string& name, const std::string& description) {
  std::string escaped;
  for (const char c : name) escaped += c == ':' ? "\\:" : std::string(1, c);
  return shell_word(escaped + ":" + description);
}

std::string zsh_value(const Value& value) {
  switch (value.kind) {
    case Value::Kind::file:
      return "_files";
    case Value::Kind::folder:
      return "_files -/";
    case Value::Kind::word: {
      std::string words;
      for (const std::string& word : value.words) words += " " + shell_word(word);
      return "compadd --" + words;
    }
    case Value::Kind::none:
    case Value::Kind::text:
      break;
  }
  return "_message 'a value'";
}

}  // namespace

std::string zsh_script(const Command& program) {
  const std::vector<const Command*> commands = with_all_below(program);
  const std::string name = program.name, function = "_" + name;
  std::ostringstream out;
  out << "#compdef " << name << '\n'
      << "# zsh completion of " << name << ": source <(" << name << " completion zsh)\n"
      << function << "() {\n"
      << "  local path_ i\n"
      << "  local -a commands options\n"
      << "  for ((i = 2; i < CURRENT; ++i)); do\n"
      << "    case \"$path_:$words[i]\" in\n";
  for (const std::string& option : with_value(program))
    out << "      *:" << option << ") ((++i)) ;;\n";
  for (const Command* command : commands) {
    for (const Command& below : command->commands) {
      out << "      " << shell_word(command->path + ":" + below.name)
          << ") path_=" << shell_word(below.path) << " ;;\n";
    }
  }
  out << "    esac\n"
      << "  done\n"
      << "  case \"$path_:$words[CURRENT-1]\" in\n";
  for (const Command* command : commands) {
    for (const Option& option : options_of(*command, program)) {
      if (option.value.kind == Value::Kind::none) continue;
      for (const std::string& of_option : option.names) {
        out << "    " << shell_word(command->path + ":" + of_option) << ") "
            << zsh_value(option.value) << "; return ;;\n";
      }
    }
  }
  out << "  esac\n"
      << "  case \"$path_\" in\n";
  for (const Command* command : commands) {
    out << "    " << shell_word(command->path) << ")\n"
        << "      options=(\n";
    for (const Option& option : options_of(*command, program))
      for (const std::string& of_option : option.names)
        out << "        " << described(of_option, option.description) << '\n';
    out << "      )\n";
    if (command->commands.empty()) {
      out << "      [[ $PREFIX == -* ]] || { " << zsh_value(first_positional(*command))
          << "; return }\n";
    } else {
      out << "      commands=(\n";
      for (const Command& below : command->commands)
        out << "        " << described(below.name, below.description) << '\n';
      out << "      )\n";
    }
    out << "      ;;\n";
  }
  out << "  esac\n"
      << "  if [[ $PREFIX == -* ]]; then\n"
      << "    _describe -o option options\n"
      << "  else\n"
      << "    _describe command commands\n"
      << "  fi\n"
      << "}\n"
      << "if [[ $funcstack[1] == " << function << " ]]; then " << function
      << " \"$@\"; else compdef " << function << ' ' << name << "; fi\n";
  return out.str();
}

}  // namespace anticrack::guide
