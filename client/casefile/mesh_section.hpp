// SPDX-License-Identifier: GPL-3.0-or-later
//
// [mesh] of a case. For the sources of this folder only.
#pragma once

#include <string>
#include <vector>

#include "casefile/requests.hpp"

namespace anticrack::casefile {

inline const std::vector<std::string> mesh_keys{"preset", "size", "tip_size", "grading",
                                                "align",  "file", "groups",   "tension"};

/// `section` is [mesh], read with mesh_keys. A key that means nothing beside the others is an
/// Error: sizes of another preset, `align` with a file, groups and tension without one.
v1::MeshOptions read_mesh_options(const Section& section, Spots& spots);

}  // namespace anticrack::casefile
