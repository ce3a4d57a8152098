// SPDX-License-Identifier: GPL-3.0-or-later
//
// Parts of the messages about a file.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesher {

/// Throws errors::Error (mesh_invalid), as the file is not a usable mesh.
template <class... Values>
[[noreturn]] void refuse(fmt::format_string<Values...> message, Values&&... values) {
  throw errors::Error(errors::Reason::mesh_invalid,
                      fmt::format(message, std::forward<Values>(values)...));
}

/// A list as text: "3, 4, 7", or with quotes "\"a\", \"b\"": at most twenty, then "and 5 more".
template <class Items>
std::string list_of(const Items& items, const char* quote = "") {
  constexpr std::size_t most = 20;
  std::string text;
  std::size_t count = 0;
  for (const auto& item : items) {
    if (count++ >= most) continue;
    text += fmt::format("{0}{1}{2}{1}", text.empty() ? "" : ", ", quote, item);
  }
  return count > most ? fmt::format("{} and {} more", text, count - most) : text;
}

/// The position of a node as "(x, y)".
inline std::string place_of(const mesh::Mesh& mesh, std::int32_t node) {
  return fmt::format("({:g}, {:g})", mesh.xy[2 * at(node)], mesh.xy[2 * at(node) + 1]);
}

}  // namespace anticrack::mesher
