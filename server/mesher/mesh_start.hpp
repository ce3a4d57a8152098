// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which formats of mesh files are read, by how a file begins. One rule for the upload, the server
// that opens the file and the helper that reads it.
#pragma once

#include <cstddef>
#include <string_view>

namespace anticrack::mesher {

enum class FileFormat {
  msh,      ///< gmsh's: $MeshFormat, or $Comments before it
  freefem,  ///< what savemesh writes as .msh: the counts of vertices, triangles and edges
  medit     ///< .mesh: MeshVersionFormatted
};

/// UTF-8's, with which some editors begin a file.
inline constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/// `format_of` needs at most so many of a file's first bytes.
inline constexpr std::size_t start_bytes = 256;

/// The format of a file that begins so; a byte order mark and white space may come first. Throws
/// errors::Error (mesh_invalid), which says what to do, for anything else: a script of gmsh, MSH 1.
FileFormat format_of(std::string_view start);

}  // namespace anticrack::mesher
