// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "store/records.hpp"

namespace anticrack::meshes {

/// Hash of all that decides what mesh a definition gives, 64 hexadecimal digits. Options without
/// effect on a preset (the tip size of one that is not graded) do not count. O(size of the
/// definition).
std::string identity(const store::MeshDefinition& definition);

/// Hash of the definition and who owns the mesh: what its id is cut from. An empty owner gives the
/// definition's.
std::string identity(const store::MeshDefinition& definition, const std::string& owner);

}  // namespace anticrack::meshes
