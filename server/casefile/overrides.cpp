// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "casefile/error.hpp"
#include "toml/long_key.hpp"
#include "words/nearest.hpp"

namespace anticrack::casefile {
namespace {

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts{""};
  for (const char c : path)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// Throws for bytes that TOML does not allow, as the case is kept as text and must parse again.
void require_text(const std::string& assignment) {
  std::string harmless = assignment;
  for (char& c : harmless)
    if (std::string_view("\n\r\t\"\\").find(c) != std::string_view::npos) c = ' ';
  try {
    static_cast<void>(toml::parse("text = \"" + harmless + "\""));
  } catch (const toml::parse_error&) {
    throw Error({"", "--set", 0},
                "it holds control characters or bytes that are not UTF-8; write plain text");
  }
}

// A table with the single key `value`; its source is the override.
toml::table parse_value(const std::string& text, const std::string& source) {
  try {
    const bool one_line = text.find_first_of("\r\n") == std::string::npos;
    if (one_line && !toml_text::line_of_long_key(text))
      return toml::parse("value = " + text, source);
  } catch (const toml::parse_error&) {
    // A bare word is text.
  }
  toml::table quoted = toml::parse("value = ''", source);
  quoted.get("value")->ref<std::string>() = text;
  return quoted;
}

std::optional<std::size_t> index_of(const std::string& word) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  return whole ? std::optional(index) : std::nullopt;
}

/// The names of the entries of a list of tables, such as [[load]]; empty unless all have a name.
std::vector<std::string> names_in(const toml::array& array) {
  std::vector<std::string> names;
  for (const toml::node& entry : array) {
    const toml::table* table = entry.as_table();
    const auto name = table ? (*table)["name"].value_exact<std::string>() : std::nullopt;
    if (!name) return {};
    names.push_back(*name);
  }
  return names;
}

/// Walks down a path of the case; errors have the part of the path walked so far.
class Walk {
 public:
  Walk(std::string source, std::vector<std::string> parts)
      : _source(std::move(source)), _parts(std::move(parts)) {}

  void assign(toml::node& root, toml::node&& value) {
    toml::node* place = &root;
    for (_depth = 0; _depth + 1 < _parts.size(); ++_depth) place = &step(*place);
    put(*place, std::move(value));
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    std::string walked;
    for (std::size_t i = 0; i <= _depth; ++i) walked += (i == 0 ? "" : ".") + _parts[i];
    throw Error({walked, _source, 0}, problem);
  }

  /// The index of the entry with this index or name; the size of the array for a new entry.
  std::size_t index_in(const toml::array& array) const {
    const std::string& part = _parts[_depth];
    const auto index = index_of(part);
    if (index && *index <= array.size()) return *index;
    const std::vector<std::string> names = names_in(array);
    const auto found = std::find(names.begin(), names.end(), part);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    if (!index && !names.empty())
      fail("none of them is called " + part + "; " + words::suggestion(part, names));
    fail(fmt::format("there is no entry {}; write an index from 0 to {}{}", part, array.size(),
                     names.empty() ? "" : ", or a name"));
  }

  toml::node& step(toml::node& place) const {
    const std::string& part = _parts[_depth];
    if (toml::table* table = place.as_table()) {
      if (!table->contains(part)) {
        // Index 0 starts a list; any other number is a name, such as the tag of a group.
        if (index_of(_parts[_depth + 1]) == std::size_t{0})
          table->insert(part, toml::array());
        else
          table->insert(part, toml::table());
      }
      return *table->get(part);
    }
    if (toml::array* array = place.as_array()) {
      const std::size_t index = index_in(*array);
      if (index == array->size()) array->push_back(toml::table());
      return *array->get(index);
    }
    fail("nothing lies below a plain value; set the key above it");
  }

  void put(toml::node& place, toml::node&& value) const {
    toml::table* table = place.as_table();
    toml::array* array = place.as_array();
    if (!table && !array) fail("nothing lies below a plain value; set the key above it");
    // Moved, not copied: only a moved node keeps its source.
    std::move(value).visit([&](auto&& node) {
      if (table) {
        table->insert_or_assign(_parts[_depth], std::forward<decltype(node)>(node));
        return;
      }
      const std::size_t index = index_in(*array);
      if (index == array->size())
        array->push_back(std::forward<decltype(node)>(node));
      else
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(index),
                       std::forward<decltype(node)>(node));
    });
  }

  std::string _source;
  std::vector<std::string> _parts;
  std::size_t _depth = 0;
};

}  // namespace

void apply_override(toml::table& root, const std::string& assignment) {
  require_text(assignment);
  const std::string source = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error({"", source, 0}, "no assignment; write --set key=value");
  std::vector<std::string> parts = split_path(assignment.substr(0, equals));
  if (std::any_of(parts.begin(), parts.end(), [](const std::string& p) { return p.empty(); }))
    throw Error({"", source, 0}, "a part of the key is empty; write for example solver.theta=2");
  if (parts.size() > toml_text::most_key_parts)
    throw Error({"", "--set", 0}, toml_text::long_key_message(5));
  toml::table parsed = parse_value(assignment.substr(equals + 1), source);
  Walk(source, std::move(parts)).assign(root, std::move(*parsed.get("value")));
}

void keep_loads(toml::table& root, const std::vector<std::string>& names) {
  toml::array* loads = root["load"].as_array();
  const std::vector<std::string> there = loads ? names_in(*loads) : std::vector<std::string>();
  const std::unordered_set<std::string> found(there.begin(), there.end()),
      wanted(names.begin(), names.end());
  for (const std::string& name : names) {
    if (found.contains(name)) continue;
    throw Error({"load", "--load " + name.substr(0, 80), 0},
                there.empty() ? "the case has no loads with names; write name = \"...\" in [[load]]"
                              : "no load is called " + name.substr(0, 80) + "; " +
                                    words::suggestion(name, there));
  }
  toml::array kept;
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (!wanted.contains(there[i])) continue;
    // Moved, not copied: only a moved node keeps its source.
    std::move(*loads->get(i)).visit([&](auto&& node) {
      kept.push_back(std::forward<decltype(node)>(node));
    });
  }
  *loads = std::move(kept);
}

}  // namespace anticrack::casefile
