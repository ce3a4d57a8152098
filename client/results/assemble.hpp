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

/// The bytes of an array inside a complete block. Throws Error if they lie outside.
ArrayView view(std::string name, ArrayView::Type type, std::vector<std::uint64_t> shape,
               std::uint64_t offset, std::span<const std::byte> block);

/// Adds the arrays to what the messages Job, Mesh and ServerInfo contain.
///
/// `answers` has everything but arrays: texts, timings, mesh.subdomains, tension and inclusions,
/// interfaces[].name in the order of Mesh.interfaces, and loads in the order of JobSpec.load_cases
/// with attributes, inclusions and contact_intervals. Filled in: mesh arrays and interfaces[].edges
/// from `mesh_block`, interfaces[].s,x,y,kind and loads[].traces, history, fields from
/// `result_block`. A load may lack arrays unless it is `converged` or `not_converged`. For a sweep
/// `answers` has no loads but sweep.loads, inclusions, kept and, if known, coefficients; filled in:
/// the columns, and a load for every kept row (see Sweep::kept).
///
/// Throws Error for a missing array, wrong types and shapes, indices out of range and sizes that
/// disagree. Unknown arrays are ignored.
Result assemble(Result answers, std::span<const ArrayView> mesh_block,
                std::span<const ArrayView> result_block);

}  // namespace anticrack::results
