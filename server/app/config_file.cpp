// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/config_file.hpp"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "toml/long_key.hpp"

namespace anticrack::app {
namespace {

std::string value_text(const Key& key, const toml::node& node, const std::string& where) {
  const bool number = key.type == KeyType::number;
  if (key.type == KeyType::flag) {
    if (const auto flag = node.value_exact<bool>()) return *flag ? "true" : "false";
    throw ConfigError(where + ": " + key.name + " takes true or false, without quotes");
  }
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (number) {
    if (const auto integer = node.value_exact<std::int64_t>()) return std::to_string(*integer);
    if (const auto real = node.value_exact<double>()) return fmt::format("{:.17g}", *real);
  }
  throw ConfigError(where + ": " + key.name + " takes a " +
                    (number ? "number, or a text like \"2GiB\"" : "text in quotes"));
}

}  // namespace

std::vector<Setting> parse_config(const std::string& text, const std::string& path) {
  if (const auto line = toml_text::line_of_long_key(text)) {
    throw ConfigError(fmt::format("{}:{}: {}", path, *line, toml_text::long_key_message(1)));
  }
  toml::table table;
  try {
    table = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw ConfigError(
        fmt::format("{}:{}: {}", path, error.source().begin.line, error.description()));
  }
  std::vector<Setting> settings;
  for (const auto& [name, node] : table) {
    const std::string where = fmt::format("{}:{}", path, node.source().begin.line);
    const std::string given(name.str());
    const Key& key = find_key(given, where);
    settings.push_back({key.name, value_text(key, node, where), where});
  }
  return settings;
}

std::vector<Setting> read_config_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw ConfigError(path + ": cannot be read: " + std::generic_category().message(errno));
  return parse_config(text.str(), path);
}

}  // namespace anticrack::app
