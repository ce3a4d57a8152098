// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/load_key.hpp"

#include <bit>
#include <cstdint>
#include <variant>

#include "fields/walk.hpp"

namespace anticrack::operators {
namespace {

void append(std::string& key, std::uint64_t value) {
  for (int shift = 0; shift < 64; shift += 8)
    key.push_back(static_cast<char>(value >> shift & 0xff));
}

void append(std::string& key, double value) {
  append(key, std::bit_cast<std::uint64_t>(value));
}

/// With its length, so that no two lists run into the same bytes.
void append(std::string& key, const std::string& text) {
  append(key, std::uint64_t{text.size()});
  key += text;
}

}  // namespace

std::optional<std::string> key_of(std::span<const fem::Load* const> loads) {
  std::string key;
  for (const fem::Load* load : loads) {
    const auto* array = std::get_if<fem::Array>(&load->force);
    if (array != nullptr && array->upload.empty()) return std::nullopt;
    fields::for_each(*load, [&key](const auto& field) {
      if (field.name != "name")
        fields::walk(field.value, [&key](const auto& leaf) { append(key, leaf); });
    });
  }
  return key;
}

}  // namespace anticrack::operators
