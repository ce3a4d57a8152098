// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// The names of the interfaces, those left empty filled in. Throws errors::Error
/// (geometry_invalid; limit_exceeded for too many) at "interfaces[0].name", "inclusions[0].name",
/// ... unless every name is one and is used once: inclusions and cracks share theirs, interfaces
/// and regions have their own.
std::vector<std::string> check_names(const Geometry& geometry);

/// `name` itself, or with "-2", "-3", ... the first one that `used` does not hold; added to `used`.
std::string unused_name(const std::string& name, std::vector<std::string>& used);

}  // namespace anticrack::mesh
