// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/json.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <utility>

#include "casefile/error.hpp"
#include "casefile/section.hpp"

namespace anticrack::casefile {
namespace {

using Json = nlohmann::json;

constexpr int most_levels = 16;  // geometry.inclusion.0.delaminated.0.0.0 has 7 levels

class Reader {
 public:
  explicit Reader(const std::string& source) : _source(source) {}

  toml::table table(const Json& object, const std::string& key, int depth) const {
    toml::table made;
    for (const auto& [name, value] : object.items()) {
      add(value, key.empty() ? name : key + "." + name, depth, [&, &key_of_it = name](auto&& node) {
        made.insert(key_of_it, std::forward<decltype(node)>(node));
      });
    }
    return made;
  }

 private:
  template <class Take>
  void add(const Json& value, const std::string& key, int depth, const Take& take) const {
    if (depth == most_levels)
      throw Error({key, _source, 0}, "no key of a case lies so deep; take levels away");
    switch (value.type()) {
      case Json::value_t::object:
        return take(table(value, key, depth + 1));
      case Json::value_t::array:
        return take(array(value, key, depth + 1));
      case Json::value_t::string:
        return take(value.get_ref<const std::string&>());
      case Json::value_t::boolean:
        return take(value.get<bool>());
      case Json::value_t::number_integer:
        return take(value.get<std::int64_t>());
      case Json::value_t::number_unsigned:
        if (value.get<std::uint64_t>() <= std::uint64_t{INT64_MAX})
          return take(value.get<std::int64_t>());
        [[fallthrough]];
      case Json::value_t::number_float:
        return take(value.get<double>());
      default:
        throw Error({key, _source, 0}, "null is not possible; leave the key out");
    }
  }

  toml::array array(const Json& list, const std::string& key, int depth) const {
    toml::array made;
    made.reserve(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
      add(list[i], entry_key(key, i), depth,
          [&](auto&& node) { made.push_back(std::forward<decltype(node)>(node)); });
    }
    return made;
  }

  const std::string& _source;
};

}  // namespace

toml::table tables_of_json(const std::string& text, const std::string& source) {
  Json parsed;
  try {
    parsed = Json::parse(text);
  } catch (const Json::exception& error) {
    throw Error({"", source, 0}, std::string("this is not JSON: ") + error.what());
  }
  if (!parsed.is_object())
    throw Error({"", source, 0},
                "this is no JSON object; write the tables of a case, as "
                "{\"geometry\": {...}, \"load\": [...]}");
  return Reader(source).table(parsed, "", 0);
}

}  // namespace anticrack::casefile
