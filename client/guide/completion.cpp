// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>

#include "guide/guide.hpp"

namespace anticrack::guide {
namespace {

constexpr std::string_view bash_script =
    R"(# bash completion of anticrack: source <(anticrack completion bash)
_anticrack() {
  local current=${COMP_WORDS[COMP_CWORD]} line
  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      :files) compopt -o filenames; COMPREPLY=($(compgen -f -- "$current")) ;;
      :folders) compopt -o filenames; COMPREPLY=($(compgen -d -- "$current")) ;;
      *=) compopt -o nospace; COMPREPLY+=("$line") ;;
      *) COMPREPLY+=("${line%%$'\t'*}") ;;
    esac
  done < <("${COMP_WORDS[0]}" --complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _anticrack anticrack
)";

constexpr std::string_view zsh_script = R"(#compdef anticrack
# zsh completion of anticrack: source <(anticrack completion zsh)
_anticrack() {
  local line
  local -a found
  for line in "${(@f)$($words[1] --complete "${(@)words[2,CURRENT]}" 2>/dev/null)}"; do
    case $line in
      :files) _files; return ;;
      :folders) _files -/; return ;;
      ?*) found+=("${line/$'\t'/:}") ;;
    esac
  done
  if (( ! $#found )); then
    _message 'a value'
  elif [[ $PREFIX == -* ]]; then
    _describe -o option found
  else
    _describe command found
  fi
}
if [[ $funcstack[1] == _anticrack ]]; then _anticrack "$@"; else compdef _anticrack anticrack; fi
)";

constexpr std::string_view fish_script =
    R"(# fish completion of anticrack: anticrack completion fish | source
function __anticrack_completions --description 'What may stand in place of the word being typed'
  set -l words (commandline -opc) (commandline -ct)
  for line in ($words[1] --complete $words[2..-1] 2>/dev/null)
    switch $line
      case :files
        __fish_complete_path (commandline -ct)
      case :folders
        __fish_complete_directories (commandline -ct)
      case '*'
        echo $line
    end
  end
end
complete -c anticrack -f -a '(__anticrack_completions)'
)";

/// Collects the lines for one word.
class Lines {
 public:
  Lines(std::string begin, std::function<std::vector<std::string>()> keys)
      : _begin(std::move(begin)), _keys(std::move(keys)) {}

  void add(const std::string& word, const std::string& description) {
    if (word.starts_with(_begin)) _text += word + '\t' + description + '\n';
  }
  void add(const Value& value) {
    if (value.kind == Value::Kind::file) _text += ":files\n";
    if (value.kind == Value::Kind::folder) _text += ":folders\n";
    const bool assigned = value.kind == Value::Kind::assignment;
    const bool keys = assigned || value.kind == Value::Kind::key;
    for (const std::string& word : keys ? _keys() : value.words)
      if (word.starts_with(_begin)) _text += word + (assigned ? "=\n" : "\n");
  }
  void add(const std::vector<Option>& options) {
    for (const Option& option : options)
      for (const std::string& name : option.names) add(name, option.description);
  }
  const std::string& text() const { return _text; }

 private:
  std::string _begin;
  std::function<std::vector<std::string>()> _keys;
  std::string _text;
};

}  // namespace

std::string_view completion_script(Shell shell) {
  return shell == Shell::bash ? bash_script : shell == Shell::zsh ? zsh_script : fish_script;
}

std::string completions(const CLI::App& app, const std::vector<std::string>& words,
                        const std::function<std::vector<std::string>()>& keys) {
  const Command program = command_tree(app);
  const Command* command = &program;
  const std::string last = words.empty() ? "" : words.back();
  Lines lines(last, keys);
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const Option* option = option_of(*command, program, words[i]);
    if (option != nullptr && option->value.kind != Value::Kind::none) {
      if (++i + 1 < words.size()) continue;
      lines.add(option->value);
      return lines.text();
    }
    const auto below = std::ranges::find(command->commands, words[i], &Command::name);
    if (below != command->commands.end()) command = &*below;
  }
  if (last.starts_with('-')) {
    lines.add(command->options);
    if (command != &program) {
      for (const Option& option : program.options)
        if (option_of(*command, program, option.names.front()) == &option) lines.add({option});
    }
  } else if (!command->commands.empty()) {
    for (const Command& below : command->commands) lines.add(below.name, below.description);
  } else if (!command->positionals.empty()) {
    lines.add(command->positionals.front().value);
  }
  return lines.text();
}

}  // namespace anticrack::guide
