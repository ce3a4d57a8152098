// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "guide/shells.hpp"

namespace anticrack::guide {
namespace {

std::string fish_value(const Value& value) {
  switch (value.kind) {
    case Value::Kind::none:
      return "";
    case Value::Kind::file:
      return " -r -F";
    case Value::Kind::folder:
      return " -x -a '(__fish_complete_directories)'";
    case Value::Kind::word:
      return " -x -a " + shell_word(joined(value.words));
    case Value::Kind::text:
      break;
  }
  return " -x";
}

std::string flags(const std::vector<std::string>& names) {
  std::string result;
  for (const std::string& name : names) {
    const bool is_long = name.rfind("--", 0) == 0;
    result += is_long ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  return result;
}

}  // namespace

std::string fish_script(const Command& program) {
  const std::vector<const Command*> commands = with_all_below(program);
  const std::string name = program.name, path = "__" + name + "_path";
  std::ostringstream out;
  out << "# fish completion of " << name << ": " << name << " completion fish | source\n"
      << "function " << path << " --description 'The command that is being typed'\n"
      << "  set -l found ''\n"
      << "  set -l is_value 0\n"
      << "  for word in (commandline -opc)[2..-1]\n"
      << "    if test $is_value = 1\n"
      << "      set is_value 0\n"
      << "      continue\n"
      << "    end\n"
      << "    switch \"$found:$word\"\n";
  for (const std::string& option : with_value(program))
    out << "      case '*:" << option << "'\n        set is_value 1\n";
  for (const Command* command : commands) {
    for (const Command& below : command->commands) {
      out << "      case " << shell_word(command->path + ":" + below.name) << "\n        set found "
          << shell_word(below.path) << '\n';
    }
  }
  out << "    end\n"
      << "  end\n"
      << "  test \"$found\" = \"$argv[1]\"\n"
      << "end\n"
      << "complete -c " << name << " -f\n";
  for (const Command* command : commands) {
    const std::string here =
        "complete -c " + name + " -n " + shell_word(path + " " + shell_word(command->path));
    for (const Command& below : command->commands) {
      out << here << " -a " << shell_word(below.name) << " -d " << shell_word(below.description)
          << '\n';
    }
    if (first_positional(*command).kind == Value::Kind::file) out << here << " -F\n";
    for (const Option& option : options_of(*command, program)) {
      out << here << flags(option.names) << fish_value(option.value) << " -d "
          << shell_word(option.description) << '\n';
    }
  }
  return out.str();
}

}  // namespace anticrack::guide
