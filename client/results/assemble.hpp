// SPDX-License-Identifier: GPL-3.0-or-later
//
// From the two binary blocks of the server (ReadMesh, ReadResult) to a Result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "results/error.hpp"
#include "results/result.hpp"
#include "results/value_type.hpp"

namespace anticrack::results {

/// One array of a block: ArrayLayout of the API plus the bytes it points at (little-endian,
/// row-major, any alignment).
struct ArrayView {
  using Type = ValueType;
  std::string name;
  Type type = Type::float64;
  std::vector<std::uint64_t> shape;
  std::span<const std::byte> bytes;  ///< exactly shape's product times 8, 4 or 1
};

/// The bytes of an array inside a block received whole. Throws Error if it lies outside.
ArrayView view(std::string name, ArrayView::Type type, std::vector<std::uint64_t> shape,
               std::uint64_t offset, std::span<const std::byte> block);

/// Adds the arrays to what the messages Job, Mesh and ServerInfo said.
///
/// `answers` comes with everything but arrays: texts, timings, mesh.subdomains, tension and
/// inclusions, interfaces[].name in the order of Mesh.interfaces, and loads in the order of
/// Job.load_cases with their attributes, inclusions and contact_intervals. Filled in here: mesh
/// arrays and interfaces[].edges from `mesh_block`, interfaces[].s,x,y,kind and loads[].traces,
/// history, fields from `result_block`. A load without arrays in the block keeps none, unless it is
/// `converged` or `not_converged`.
/// Of a sweep it comes without loads and with sweep.loads, inclusions, kept and, where known,
/// coefficients; filled in are the columns, and a load for every kept row (see Sweep::kept).
///
/// Nothing is believed: a missing array, a type, a shape, an index out of range or a size that
/// disagrees with another throws Error. Arrays this version does not know are passed over.
Result assemble(Result answers, std::span<const ArrayView> mesh_block,
                std::span<const ArrayView> result_block);

}  // namespace anticrack::results
