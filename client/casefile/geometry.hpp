// SPDX-License-Identifier: GPL-3.0-or-later
//
// [geometry] of a case. For the sources of this folder only.
#pragma once

#include <string>
#include <vector>

#include "casefile/requests.hpp"

namespace anticrack::casefile {

inline const std::vector<std::string> geometry_keys{"boundary", "interface", "inclusion",
                                                    "crack",    "neumann",   "region"};

/// `section` is [geometry], read with geometry_keys.
v1::Geometry read_geometry(const Section& section, Spots& spots);

/// Its `interface`: one line of points, or tables with points, arc or spline; none: no interface.
void read_interfaces(const Section& section, v1::Geometry& geometry, Spots& spots);

}  // namespace anticrack::casefile
