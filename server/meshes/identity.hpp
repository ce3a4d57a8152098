// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "records/mesh_record.hpp"

namespace anticrack::meshes {

/// Hash of a definition, 64 hexadecimal digits. Definitions have equal hashes if they give the same
/// mesh; options without effect are ignored (tip size without grading). O(size of the definition).
std::string identity(const records::MeshDefinition& definition);

/// Hash of the definition and the owner, whose first digits are the mesh's id. For an empty owner
/// it is the hash of the definition.
std::string identity(const records::MeshDefinition& definition, const std::string& owner);

}  // namespace anticrack::meshes
