// SPDX-License-Identifier: GPL-3.0-or-later
//
// [geometry] of a case. For the sources of this folder only.
#pragma once

#include <map>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "casefile/section.hpp"

namespace anticrack::casefile {

using Spots = std::map<std::string, Spot>;

inline const std::vector<std::string> geometry_keys{"boundary", "interface", "inclusion", "crack"};

/// `section` is [geometry], read with geometry_keys.
v1::Geometry read_geometry(const Section& section, Spots& spots);

}  // namespace anticrack::casefile
