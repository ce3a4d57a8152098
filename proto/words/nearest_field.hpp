// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is known of a field of a request, where it may be known only of one around it.
#pragma once

#include <string>
#include <string_view>

namespace anticrack::words {

/// The entry of a map with the path of a field, "load_cases[0].force.expression", or else with that
/// of the nearest field around it; null where there is none. A path may begin with the request's
/// "spec." or "mesh.".
template <class Map>
const typename Map::mapped_type* nearest_field(const Map& known, std::string_view path) {
  for (const std::string_view request : {"spec.", "mesh."})
    if (path.starts_with(request)) path.remove_prefix(request.size());
  while (!path.empty()) {
    if (const auto found = known.find(std::string(path)); found != known.end())
      return &found->second;
    const std::size_t cut = path.find_last_of(".[");
    path = path.substr(0, cut == std::string_view::npos ? 0 : cut);
  }
  return nullptr;
}

}  // namespace anticrack::words
