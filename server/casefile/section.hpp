// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads a table of a case by key, with the errors of error.hpp. For this folder only.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "casefile/error.hpp"
#include "casefile/keys.hpp"

namespace anticrack::casefile {

using Point = std::array<double, 2>;

/// The place where a node was written. `key`: its path.
Spot spot_of(const toml::node& node, std::string key);

/// A value as written in the case, shortened, for error messages.
std::string shown(const toml::node& node);

/// A finite number. Throws Error: "... is not a number; CURE".
double number_of(const toml::node& node, const std::string& key, std::string_view cure);
/// A number above 0. Throws Error for others, and mentions the default if there is one.
double positive_of(const toml::node& node, const std::string& key, bool has_default = true);
/// Two finite numbers. Throws Error: "... is not WHAT; CURE".
Point pair_of(const toml::node& node, const std::string& key, const std::string& what,
              std::string_view cure);
/// A point [x, y] with finite coordinates.
Point point_of(const toml::node& node, const std::string& key);
/// Points [[x, y], ...].
std::vector<Point> points_of(const toml::node& node, const std::string& key);

/// The key of an entry of a list: "list.3".
std::string entry_key(const std::string& list, std::size_t index);

class Section {
 public:
  /// Throws Error for a key that is not among `keys`, naming the nearest of them.
  Section(const toml::table& table, std::string path, const Keys& keys);

  /// The value of a key; null if it is absent.
  const toml::node* find(std::string_view key) const { return _table.get(key); }
  const toml::table& table() const { return _table; }
  const Keys& keys() const { return *_keys; }
  /// The keys of tables below a key.
  const Keys& below(std::string_view key) const { return *_keys->find(key)->below; }
  /// The path of a key for messages: "load.force".
  std::string path_of(std::string_view key) const;
  /// The same for an entry of the key's table: "load.force.NAME".
  std::string path_of(std::string_view key, std::string_view name) const;
  /// The place where the key's value was written; if it is absent, where the table begins.
  Spot spot_of(std::string_view key) const;
  /// The place where the table begins.
  Spot spot() const { return casefile::spot_of(_table, _path); }

  // Values of a key, empty if it is absent. They throw Error if the value has another type.
  std::optional<std::string> text(std::string_view key) const;
  std::optional<double> number(std::string_view key) const;
  /// An expression in quotes, or a number.
  std::optional<std::string> expression(std::string_view key) const;
  /// The entries of {name = value, ...}, in the order of the names; empty if the key is absent.
  std::vector<std::pair<std::string, const toml::node*>> entries(std::string_view key,
                                                                 std::string_view cure) const;
  /// The numbers of {name = number, ...}, in the order of the names.
  std::vector<std::pair<std::string, double>> numbers(std::string_view key,
                                                      std::string_view cure) const;
  std::optional<std::int32_t> count(std::string_view key) const;
  std::optional<bool> boolean(std::string_view key) const;
  std::optional<Section> section(std::string_view key) const;
  /// The tables of [[path.key]]; empty if it is absent.
  std::vector<Section> sections(std::string_view key) const;
  /// The index of the value among `choices`. Throws Error with the nearest for other names.
  std::optional<std::size_t> choice(std::string_view key,
                                    const std::vector<std::string>& choices) const;

  /// The value of a key that must be present. Throws Error if it is absent: "missing; CURE".
  const toml::node& need(std::string_view key, std::string_view cure) const;
  /// The same with the cure of the key's row.
  const toml::node& need(std::string_view key) const { return need(key, _keys->find(key)->need); }

 private:
  template <class T>
  std::optional<T> exact(std::string_view key, const char* problem) const;

  const toml::table& _table;
  std::string _path;
  const Keys* _keys;
};

}  // namespace anticrack::casefile
