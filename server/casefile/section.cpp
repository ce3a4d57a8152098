// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/section.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "words/nearest.hpp"

namespace anticrack::casefile {
namespace {

std::string join(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

}  // namespace

std::string entry_key(const std::string& list, std::size_t index) {
  return fmt::format("{}.{}", list, index);
}

std::string where(const Spot& spot) {
  if (spot.line == 0) return spot.source;
  return fmt::format("{}{}", spot.source.empty() ? "line " : spot.source + ":", spot.line);
}

std::string prefix(const Spot& spot) {
  std::string text = where(spot);
  if (!spot.key.empty()) text += (text.empty() ? "" : ": ") + spot.key;
  return text.empty() ? text : text + ": ";
}

namespace {

// The name or index by which an override finds the entry of a list.
std::string name_or_index(const toml::table& entry, std::size_t index) {
  const auto name = entry["name"].value_exact<std::string>();
  constexpr std::size_t longest = 64;
  const bool short_enough = name && !name->empty() && name->size() <= longest;
  return short_enough ? *name : std::to_string(index);
}

// The first node in a table that was written. Tables that an override makes on the way to its value
// have no source of their own.
const toml::node& first_written(const toml::node& node) {
  const toml::table* table = node.as_table();
  const toml::array* array = node.as_array();
  if (node.source().path || (table ? table->empty() : !array || array->empty())) return node;
  return first_written(table ? table->cbegin()->second : *array->get(0));
}

}  // namespace

Spot spot_of(const toml::node& node, std::string key) {
  const toml::source_region& region = first_written(node).source();
  Spot spot{std::move(key), region.path ? *region.path : std::string(), region.begin.line};
  if (spot.source.rfind("--set", 0) == 0) spot.line = 0;  // an override has one line only
  return spot;
}

namespace {

/// The shortest text that reads back as the same number.
std::string number_text(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

}  // namespace

std::string shown(const toml::node& node) {
  constexpr std::size_t longest = 60;
  std::ostringstream out;
  if (const toml::table* table = node.as_table()) {
    toml::table on_one_line(*table);
    on_one_line.is_inline(true);
    out << toml::array{on_one_line}.get(0)->ref<toml::table>();
  } else if (const toml::value<double>* number = node.as_floating_point()) {
    out << number_text(**number);  // toml_formatter writes 17 digits
  } else {
    node.visit([&out](const auto& value) { out << toml::toml_formatter(value); });
  }
  std::string text = out.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

namespace {

/// The number in a text like "100 mm"; empty for any other text, such as "infinite".
std::string before_unit(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const char* const stop = std::from_chars(text.data(), end, value).ptr;
  const char* const unit = std::find_if(stop, end, [](char c) { return c != ' '; });
  const bool named =
      unit != end && std::isfinite(value) && std::isalpha(static_cast<unsigned char>(*unit)) != 0;
  return named ? std::string(text.data(), stop) : std::string();
}

}  // namespace

double number_of(const toml::node& node, const std::string& key, std::string_view cure) {
  const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
  if (value && std::isfinite(*value)) return *value;
  const std::string plain = before_unit(node.value_exact<std::string>().value_or(""));
  throw Error(
      spot_of(node, key),
      shown(node) + (plain.empty() ? " is not a finite number; " + std::string(cure)
                                   : " is a number with a unit; write " + plain +
                                         ": the units of all numbers are those of [units]"));
}

namespace {

const char* finite(const toml::node& node) {
  return node.is_string() ? "write a number without quotes" : "write a finite number";
}

}  // namespace

double positive_of(const toml::node& node, const std::string& key, bool has_default) {
  const double value = number_of(node, key, finite(node));
  if (value > 0) return value;
  throw Error(spot_of(node, key),
              shown(node) + " is not above 0; write a number above 0" +
                  (has_default ? ", or leave the key out for its default" : ""));
}

Point pair_of(const toml::node& node, const std::string& key, const std::string& what,
              std::string_view cure) {
  const toml::array* pair = node.as_array();
  if (!pair || pair->size() != 2)
    throw Error(spot_of(node, key), shown(node) + " is not " + what + "; " + std::string(cure));
  return {number_of(*pair->get(0), key, cure), number_of(*pair->get(1), key, cure)};
}

Point point_of(const toml::node& node, const std::string& key) {
  return pair_of(node, key, "a point", "write [x, y]");
}

std::vector<Point> points_of(const toml::node& node, const std::string& key) {
  const toml::array* list = node.as_array();
  if (!list) {
    throw Error(spot_of(node, key),
                shown(node) + " is not a list of points; write [[x, y], [x, y], ...]");
  }
  std::vector<Point> points;
  points.reserve(list->size());
  for (std::size_t i = 0; i < list->size(); ++i)
    points.push_back(point_of(*list->get(i), entry_key(key, i)));
  return points;
}

namespace {

[[noreturn]] void refuse(std::string_view key, const Keys& keys, Spot spot) {
  if (const Key* const row = keys.find(key))
    throw Error(std::move(spot), std::string(row->meaning));
  std::vector<std::string> names;
  for (const Key* row : keys.known()) names.emplace_back(row->name);
  throw Error(std::move(spot), "unknown key; " + words::suggestion(key, names));
}

}  // namespace

Section::Section(const toml::table& table, std::string path, const Keys& keys)
    : _table(table), _path(std::move(path)), _keys(&keys) {
  for (const auto& [key, node] : _table) {
    const Key* const row = keys.find(key.str());
    if (row && row->type != Type::refused) continue;
    Spot spot = casefile::spot_of(node, path_of(key.str()));
    if (!row && spot.line > 0 && key.source().begin.line > 0) spot.line = key.source().begin.line;
    refuse(key.str(), keys, std::move(spot));
  }
}

std::string Section::path_of(std::string_view key) const { return join(_path, key); }

std::string Section::path_of(std::string_view key, std::string_view name) const {
  return join(path_of(key), name);
}

Spot Section::spot_of(std::string_view key) const {
  const toml::node* node = find(key);
  return node ? casefile::spot_of(*node, path_of(key)) : spot();
}

template <class T>
std::optional<T> Section::exact(std::string_view key, const char* problem) const {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  auto value = node->value_exact<T>();
  if (!value) throw Error(spot_of(key), shown(*node) + problem);
  return value;
}

std::optional<std::string> Section::text(std::string_view key) const {
  return exact<std::string>(key, " is not text; write it in quotes");
}

std::optional<bool> Section::boolean(std::string_view key) const {
  return exact<bool>(key, " is neither true nor false");
}

std::optional<double> Section::number(std::string_view key) const {
  const toml::node* node = find(key);
  return node ? std::optional(number_of(*node, path_of(key), finite(*node))) : std::nullopt;
}

std::optional<std::string> Section::expression(std::string_view key) const {
  const toml::node* node = find(key);
  if (!node || node->is_string()) return text(key);
  return number_text(
      number_of(*node, path_of(key), "write a number, or an expression in x and y in quotes"));
}

std::vector<std::pair<std::string, const toml::node*>> Section::entries(
    std::string_view key, std::string_view cure) const {
  const toml::node* node = find(key);
  if (!node) return {};
  const toml::table* table = node->as_table();
  if (!table) throw Error(spot_of(key), shown(*node) + " is not a table; " + std::string(cure));
  std::vector<std::pair<std::string, const toml::node*>> found;
  found.reserve(table->size());
  for (const auto& [name, entry] : *table) found.emplace_back(name.str(), &entry);
  return found;
}

std::vector<std::pair<std::string, double>> Section::numbers(std::string_view key,
                                                             std::string_view cure) const {
  std::vector<std::pair<std::string, double>> values;
  for (const auto& [name, entry] : entries(key, cure))
    values.emplace_back(name, number_of(*entry, path_of(key, name), cure));
  return values;
}

std::optional<std::int32_t> Section::count(std::string_view key) const {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  constexpr std::int64_t largest = std::numeric_limits<std::int32_t>::max();
  const auto value = node->value_exact<std::int64_t>();
  if (!value || *value < 1 || *value > largest) {
    throw Error(spot_of(key), fmt::format("{} is not a count; write a whole number from 1 to {}",
                                          shown(*node), largest));
  }
  return static_cast<std::int32_t>(*value);
}

std::optional<Section> Section::section(std::string_view key) const {
  const toml::node* node = find(key);
  if (!node) return std::nullopt;
  const toml::table* table = node->as_table();
  if (!table)
    throw Error(spot_of(key), shown(*node) + " is not a table; write [" + path_of(key) + "]");
  return Section(*table, path_of(key), below(key));
}

std::vector<Section> Section::sections(std::string_view key) const {
  const toml::node* node = find(key);
  if (!node) return {};
  const std::string cure = "; write [[" + path_of(key) + "]] above each of them";
  const toml::array* list = node->as_array();
  if (!list) throw Error(spot_of(key), shown(*node) + " is not a list of tables" + cure);
  std::vector<Section> sections;
  sections.reserve(list->size());
  for (std::size_t i = 0; i < list->size(); ++i) {
    const toml::node& entry = *list->get(i);
    const toml::table* table = entry.as_table();
    const std::string path =
        table ? path_of(key, name_or_index(*table, i)) : entry_key(path_of(key), i);
    if (!table)
      throw Error(casefile::spot_of(entry, path), shown(entry) + " is not a table" + cure);
    sections.emplace_back(*table, path, below(key));
  }
  return sections;
}

std::optional<std::size_t> Section::choice(std::string_view key,
                                           const std::vector<std::string>& choices) const {
  const std::optional<std::string> value = text(key);
  if (!value) return std::nullopt;
  const auto found = std::find(choices.begin(), choices.end(), *value);
  if (found == choices.end()) {
    throw Error(spot_of(key),
                shown(*find(key)) + " is not possible; " + words::suggestion(*value, choices));
  }
  return static_cast<std::size_t>(found - choices.begin());
}

const toml::node& Section::need(std::string_view key, std::string_view cure) const {
  const toml::node* node = find(key);
  if (!node) {
    Spot here = spot();
    here.key = path_of(key);
    here.line = _path.empty() ? 0 : here.line;  // a key missing in the whole case has no line
    throw Error(std::move(here), "missing; " + std::string(cure));
  }
  return *node;
}

}  // namespace anticrack::casefile
