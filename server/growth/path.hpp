// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "fields/fields.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::growth {

/// A stretch of an interface that holds at first. The mesh has there what it becomes, delaminated
/// or a crack.
struct Path {
  std::string interface;     ///< its name
  mesh::Point from{}, to{};  ///< its ends, in either order
  std::string toughness;     ///< Gc, an expression in x and y, [F]
};
ANTICRACK_FIELDS(Path, interface, from, to, toughness)

}  // namespace anticrack::growth
