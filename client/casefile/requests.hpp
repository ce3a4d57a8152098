// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the readers of the sections share: points of the API, and where the parts of a request were
// written. For the sources of this folder only.
#pragma once

#include <map>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "casefile/section.hpp"

namespace anticrack::casefile {

/// Field of a request -> where its value was written.
using Spots = std::map<std::string, Spot>;

/// Writes both coordinates.
inline void set(v1::Point& point, const Point& xy) {
  point.set_x(xy[0]);
  point.set_y(xy[1]);
}

/// "list[3]": the field of an entry of a repeated field.
inline std::string entry_field(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

/// The spot of an entry of a map, under either way to name one.
inline void set_entry(Spots& spots, const std::string& map, const std::string& key,
                      const Spot& spot) {
  spots[map + "[" + key + "]"] = spot;
  spots[map + "." + key] = spot;
}

/// Adds the points of a node [[x, y], ...] to a repeated field, and their spots.
template <class Points>
void add_points(const toml::node& node, const std::string& key, const std::string& field,
                Points& points, Spots& spots) {
  const std::vector<Point> list = points_of(node, key);
  for (std::size_t i = 0; i < list.size(); ++i) {
    set(*points.Add(), list[i]);
    spots[entry_field(field, i)] = spot_of(*node.as_array()->get(i), entry_key(key, i));
  }
}

}  // namespace anticrack::casefile
