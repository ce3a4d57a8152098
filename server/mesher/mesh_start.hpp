// SPDX-License-Identifier: GPL-3.0-or-later
//
// Recognises the formats of mesh files that can be read, by the beginning of a file. The upload,
// the server that opens the file and the helper that reads it have this one rule.
#pragma once

#include <cstddef>
#include <string_view>

namespace anticrack::mesher {

enum class FileFormat {
  msh,      ///< of gmsh: $MeshFormat, or $Comments before it
  freefem,  ///< .msh of savemesh: the counts of vertices, triangles and edges
  medit     ///< .mesh: MeshVersionFormatted
};

/// The byte order mark of UTF-8, with which some editors begin a file.
inline constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/// `format_of` needs at most this many of a file's first bytes.
inline constexpr std::size_t start_bytes = 256;

/// The format of a file with this beginning; a byte order mark and white space may come first.
/// Throws errors::Error (mesh_invalid) with the cure for anything else: a script of gmsh, MSH 1.
FileFormat format_of(std::string_view start);

}  // namespace anticrack::mesher
