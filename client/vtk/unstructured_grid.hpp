// SPDX-License-Identifier: GPL-3.0-or-later
//
// A .vtu file: VTK's XML around raw little-endian arrays. Written here and not by the VTK library,
// which is forty times the size of this client for a header and a run of arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace anticrack::vtk {

/// One value an entry: a point or a cell.
struct RealData {
  std::string name;
  std::vector<double> values;
};

struct IntegerData {
  std::string name;
  std::vector<std::int32_t> values;
};

struct Attributes {
  std::vector<RealData> reals;
  std::vector<IntegerData> integers;
};

enum class Cell : std::uint8_t { line = 3, triangle = 5 };  ///< the numbers are VTK's

/// Cells of one shape in the plane z = 0. Index base 0.
struct UnstructuredGrid {
  std::vector<double> xy;  ///< (n,2) row-major
  Cell shape = Cell::triangle;
  std::vector<std::int32_t> corners;  ///< (m, 2 or 3) row-major
  Attributes points;                  ///< (n) each
  Attributes cells;                   ///< (m) each
};

/// The bytes of the file: format version 1.0, appended data in raw encoding, 64-bit lengths. Names
/// are written as they are: letters, digits and "_" only. Throws std::invalid_argument where a
/// length does not fit. O(bytes).
std::string to_vtu(const UnstructuredGrid& grid);

/// A file of a collection.
struct Member {
  std::string name;  ///< for people; any text
  std::string file;  ///< beside the .pvd
  std::size_t step = 0;
  std::size_t part = 0;
};

/// The bytes of a .pvd: the step is what ParaView shows as time.
std::string to_pvd(const std::vector<Member>& members);

}  // namespace anticrack::vtk
