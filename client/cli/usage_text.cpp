// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <utility>

#include "guide/guide.hpp"
#include "words/nearest.hpp"

namespace anticrack::cli {
namespace {

using Words = std::vector<std::string>;

Words commands_of(const CLI::App& command) {
  Words names;
  for (const CLI::App* below : guide::commands_of(command)) names.push_back(below->get_name());
  return names;
}

/// Walks the words as CLI11 does, to the command that is meant and the first unknown word.
class Walk {
 public:
  Walk(const CLI::App& program, const Words& words)
      : _program(program), _level(&program), _words(words) {}

  /// The problem; empty if every word has its place.
  std::string problem() {
    for (; _next < _words.size(); ++_next) {
      const std::string& word = _words[_next];
      if (word == "--") return "";
      const bool option = word.size() > 1 && word.front() == '-';
      if (std::string found = option ? of_option(word) : of_word(word); !found.empty())
        return found;
    }
    return "";
  }

  const CLI::App& level() const { return *_level; }
  std::string path() const { return guide::path_of(*_level); }
  std::string see() const { return "; see " + path() + " --help"; }

 private:
  std::string of_option(const std::string& word) {
    const bool is_long = word[1] == '-';
    const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const CLI::Option* option = guide::option_of(*_level, name);
    if (option == nullptr) return unknown_option(is_long ? name : word);
    const bool holds_value = word.size() > name.size();
    _next += !guide::type_of(*option).empty() && !holds_value ? 1 : 0;
    return "";
  }

  std::string unknown_option(const std::string& name) const {
    std::string takers;
    for (const CLI::App* command : guide::with_all_below(*_level))
      if (command->get_option_no_throw(name) != nullptr)
        takers += (takers.empty() ? "" : ", ") + guide::path_of(*command).substr(path().size() + 1);
    if (!takers.empty())
      return name + " is an option of " + takers + "; write it behind the command";
    Words names;
    for (const CLI::App* command : {_level, &_program})
      for (const CLI::Option* option : guide::options_of(*command))
        if (!option->get_lnames().empty()) names.push_back("--" + option->get_lnames().back());
    const auto meant = words::nearest(name, names);
    return "unknown option " + name + " of " + path() +
           (meant ? "; did you mean " + *meant + "?" : see());
  }

  std::string of_word(const std::string& word) {
    if (guide::commands_of(*_level).empty()) {
      const auto options = guide::options_of(*_level);
      return ++_arguments > std::ranges::count_if(options, &CLI::Option::get_positional)
                 ? "unexpected argument " + word + " of " + path() + see()
                 : "";
    }
    const CLI::App* const below = guide::command_of(*_level, word);
    if (below == nullptr) return "unknown command " + word + "; " + cure(word);
    _level = below;
    return "";
  }

  // The cure for a user who forgot the command.
  std::string cure(const std::string& word) const {
    for (const auto& [end, command] : {std::pair{".toml", "run"}, std::pair{".h5", "show"}})
      if (word.ends_with(end) && _level == &_program)
        return std::string("did you mean anticrack ") + command + " " + word + "?";
    return words::suggestion(word, commands_of(*_level));
  }

  const CLI::App& _program;
  const CLI::App* _level;
  const Words& _words;
  std::size_t _next = 0;
  std::ptrdiff_t _arguments = 0;
};

std::string before_colon(const std::string& text) { return text.substr(0, text.find(':')); }

// CLI11's own message, extended by what to do.
std::string of_error(const CLI::ParseError& error) {
  std::string text = error.what();
  const std::string kind = error.get_name();
  if (kind == "ArgumentMismatch") {
    return before_colon(text) + (text.find("missing") != std::string::npos
                                     ? " needs a value"
                                     : " is given more than once; keep one");
  }
  if (kind == "ExcludesError") {
    const std::size_t word = text.find(" excludes ");
    return text.substr(0, word) + " and " + text.substr(word + 10) +
           " exclude each other; leave one out";
  }
  if (kind == "ConversionError") return text.substr(text.find(": ") + 2) + " is not possible";
  const std::size_t list = text.find('[');
  if (text.starts_with("Exactly 1 ") && list != std::string::npos) {
    std::string names;
    for (const char c : text.substr(list + 1, text.find(']') - list - 1))
      names += c == ',' ? std::string(", ") : std::string(1, c);
    return "give exactly one of " + names;
  }
  return text;
}

}  // namespace

std::string usage_text(const CLI::App& app, const CLI::ParseError& error, const Words& words) {
  Walk walk(app, words);
  if (std::string problem = walk.problem(); !problem.empty()) return problem;
  if (!guide::commands_of(walk.level()).empty()) {
    return "a command is missing after " + walk.path() + "; " +
           words::suggestion("", commands_of(walk.level()));
  }
  return of_error(error) + walk.see();
}

}  // namespace anticrack::cli
