// SPDX-License-Identifier: GPL-3.0-or-later
//
// A .vtu file: VTK's XML around raw little-endian arrays. The VTK library would be forty times the
// size of this client.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace anticrack::vtk {

/// A value for each point or cell.
struct Data {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int32_t>> values;
  std::string unit{};  ///< VTK's UNITS_LABEL; any text, empty: none
};

enum class Cell : std::uint8_t { line = 3, triangle = 5 };  ///< the numbers are VTK's

/// Cells of one shape in the plane z = 0. Index base 0.
struct UnstructuredGrid {
  std::vector<double> xy;  ///< (n,2) row-major
  Cell shape = Cell::triangle;
  std::vector<std::int32_t> corners;  ///< (m, 2 or 3) row-major
  std::vector<Data> points;           ///< (n) each
  std::vector<Data> cells;            ///< (m) each
};

/// The bytes of the file: format version 1.0, appended raw data, 64-bit lengths. Names are not
/// escaped: letters, digits and "_" only. Throws std::invalid_argument for wrong lengths. O(bytes).
std::string to_vtu(const UnstructuredGrid& grid);

/// A file of a .pvd.
struct Member {
  std::string name;  ///< shown to users; any text
  std::string file;  ///< path relative to the .pvd
  std::size_t step = 0;
  std::size_t part = 0;
};

/// The bytes of a .pvd; ParaView shows the step as time.
std::string to_pvd(const std::vector<Member>& members);

}  // namespace anticrack::vtk
