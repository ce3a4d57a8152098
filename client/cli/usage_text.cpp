// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <utility>

#include "casefile/nearest.hpp"

namespace anticrack::cli {
namespace {

using Words = std::vector<std::string>;

Words commands_of(CLI::App& app) {
  Words names;
  for (const CLI::App* command : app.get_subcommands({}))
    if (!command->get_name().empty())  // else it is a group of options
      names.push_back(command->get_name());
  return names;
}

/// "anticrack job watch".
std::string path_of(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  return (parent == nullptr ? "" : path_of(*parent) + " ") + app.get_name();
}

// An option of a command or of one above it, whose options it takes too; null for none.
const CLI::Option* option_of(const CLI::App* app, const std::string& name) {
  for (; app != nullptr; app = app->get_parent())
    if (const CLI::Option* option = app->get_option_no_throw(name)) return option;
  return nullptr;
}

void add_options_of(const CLI::App& app, Words& names) {
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const auto is_group = [](const CLI::App* below) { return below->get_name().empty(); };
  for (const CLI::App* group : app.get_subcommands(is_group)) add_options_of(*group, names);
}

// Long names of all options that a command takes, its own first.
Words options_of(const CLI::App* app) {
  Words names;
  for (; app != nullptr; app = app->get_parent()) add_options_of(*app, names);
  return names;
}

std::string see(const CLI::App& app) { return "; see " + path_of(app) + " --help"; }

// "run, mesh create": the commands below `app` that take an option.
std::string takers_below(const CLI::App& app, const std::string& name, const std::string& path) {
  std::string takers;
  const auto add = [&takers](const std::string& more) {
    takers += takers.empty() || more.empty() ? more : ", " + more;
  };
  const auto is_command = [](const CLI::App* below) { return !below->get_name().empty(); };
  for (const CLI::App* command : app.get_subcommands(is_command)) {
    const std::string here = path + command->get_name();
    add(command->get_option_no_throw(name) == nullptr ? "" : here);
    add(takers_below(*command, name, here + " "));
  }
  return takers;
}

std::string unknown_option(const CLI::App& app, const std::string& name) {
  if (const std::string takers = takers_below(app, name, ""); !takers.empty())
    return name + " is an option of " + takers + "; write it behind the command";
  const auto meant = casefile::nearest(name, options_of(&app));
  return "unknown option " + name + " of " + path_of(app) +
         (meant ? "; did you mean " + *meant + "?" : see(app));
}

/// Walks the words as CLI11 does, to the command that is meant and the first word it does not know.
class Walk {
 public:
  Walk(CLI::App& app, const Words& words) : _level(&app), _words(words) {}

  /// Empty where every word has its place.
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

  CLI::App& level() const { return *_level; }

 private:
  std::string of_option(const std::string& word) {
    const bool is_long = word[1] == '-';
    const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const CLI::Option* option = option_of(_level, name);
    if (option == nullptr) return unknown_option(*_level, is_long ? name : word);
    const bool holds_value = word.size() > name.size();
    _next += option->get_items_expected_max() > 0 && !holds_value ? 1 : 0;
    return "";
  }

  std::string of_word(const std::string& word) {
    const Words commands = commands_of(*_level);
    if (commands.empty()) {
      const auto places =
          _level->get_options([](const CLI::Option* o) { return o->get_positional(); }).size();
      return ++_arguments > places
                 ? "unexpected argument " + word + " of " + path_of(*_level) + see(*_level)
                 : "";
    }
    if (std::find(commands.begin(), commands.end(), word) == commands.end())
      return "unknown command " + word + "; " + cure(word, commands);
    _level = _level->get_subcommand(word);
    return "";
  }

  // What a person types who forgets the command.
  std::string cure(const std::string& word, const Words& commands) const {
    for (const auto& [end, command] : {std::pair{".toml", "run"}, std::pair{".h5", "show"}})
      if (word.ends_with(end) && _level->get_parent() == nullptr)
        return std::string("did you mean anticrack ") + command + " " + word + "?";
    return casefile::suggestion(word, commands);
  }

  CLI::App* _level;
  const Words& _words;
  std::size_t _next = 0;
  std::size_t _arguments = 0;
};

std::string before_colon(const std::string& text) { return text.substr(0, text.find(':')); }

// CLI11's own words, made to say what to do.
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

std::string usage_text(CLI::App& app, const CLI::ParseError& error, const Words& words) {
  Walk walk(app, words);
  if (std::string problem = walk.problem(); !problem.empty()) return problem;
  const Words commands = commands_of(walk.level());
  if (!commands.empty()) {
    return "a command is missing after " + path_of(walk.level()) + "; " +
           casefile::suggestion("", commands);
  }
  return of_error(error) + see(walk.level());
}

}  // namespace anticrack::cli
