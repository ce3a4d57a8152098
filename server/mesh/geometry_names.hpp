// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// The names of the interfaces, empty ones filled in. Throws errors::Error (geometry_invalid, or
/// limit_exceeded) at "interfaces[0].name", "inclusions[0].name", ... for a malformed name or one
/// used twice; inclusions and cracks share one set of names, interfaces and regions have their own.
std::vector<std::string> check_names(const Geometry& geometry);

/// `name`, or the first of `name`-2, `name`-3, ... not in `used`; added to `used`.
std::string unused_name(const std::string& name, std::vector<std::string>& used);

}  // namespace anticrack::mesh
