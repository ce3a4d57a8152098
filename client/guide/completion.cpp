// SPDX-License-Identifier: GPL-3.0-or-later

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>

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
  /// Adds what the value of an option or an argument may be, by the type that --help gives.
  void add_values(const std::string& type) {
    if (type.starts_with("FILE")) _text += ":files\n";  // FILE.csv, too
    if (type == "DIR") _text += ":folders\n";
    std::vector<std::string> words;
    if (type.starts_with('{')) {
      std::istringstream list(type.substr(1, type.size() - 2));
      for (std::string word; std::getline(list, word, ',');) words.push_back(word);
    }
    const bool assigned = type == "KEY=VALUE";
    if (assigned || type == "KEY") words = _keys();
    for (const std::string& word : words)
      if (word.starts_with(_begin)) _text += word + (assigned ? "=\n" : "\n");
  }
  void add(const CLI::Option& option) {
    if (option.get_positional()) return;
    for (const std::string& name : names_of(option)) add(name, option.get_description());
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
  const CLI::App* command = &app;
  const std::string last = words.empty() ? "" : words.back();
  Lines lines(last, keys);
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const CLI::Option* option = words[i].starts_with('-') ? option_of(*command, words[i]) : nullptr;
    if (option != nullptr && !type_of(*option).empty()) {
      if (++i + 1 < words.size()) continue;
      lines.add_values(type_of(*option));
      return lines.text();
    }
    if (const CLI::App* below = command_of(*command, words[i])) command = below;
  }
  if (last.starts_with('-')) {
    for (const CLI::Option* option : options_of(*command)) lines.add(*option);
    for (const CLI::Option* option : options_of(app))
      if (command != &app && option_of(*command, names_of(*option).front()) == option)
        lines.add(*option);
    return lines.text();
  }
  for (const CLI::App* below : commands_of(*command))
    lines.add(below->get_name(), below->get_description());
  const auto options = options_of(*command);
  const auto argument = std::ranges::find_if(options, &CLI::Option::get_positional);
  if (argument != options.end()) lines.add_values(type_of(**argument));
  return lines.text();
}

}  // namespace anticrack::guide
