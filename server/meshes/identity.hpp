// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "records/records.hpp"

namespace anticrack::meshes {

/// Hash of a definition, 64 hexadecimal digits: equal if they give the same mesh. Ignores options
/// without effect (tip size without grading). O(size of the definition).
std::string identity(const records::MeshDefinition& definition);

/// Hash of the definition and the owner, whose first digits are the mesh's id; for an empty owner
/// that of the definition.
std::string identity(const records::MeshDefinition& definition, const std::string& owner);

}  // namespace anticrack::meshes
