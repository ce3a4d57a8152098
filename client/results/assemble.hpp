// SPDX-License-Identifier: GPL-3.0-or-later
//
// From the two binary blocks of the server (ReadMesh, ReadResult) to a Result.
#pragma once

#include <cstddef>
#include <span>

#include "anticrack/v1/mesh.pb.h"
#include "results/error.hpp"
#include "results/result.hpp"

namespace anticrack::results {

/// A whole block, and what it says of the arrays in it.
struct BlockView {
  const v1::BlockLayout& layout;
  std::span<const std::byte> bytes;
};

/// Adds the arrays to what the messages of the server say.
///
/// `answers` has everything but arrays. Filled in: those of the mesh from `mesh_block`, interfaces
/// from both, loads[].traces, history, fields and indicator from `result_block`. A load may lack
/// arrays unless it is `converged` or `not_converged`.
/// For a sweep `answers` has no loads but sweep.loads, inclusions, kept and answer; filled in: the
/// columns, and a load for every kept row (see Sweep::kept).
///
/// Throws Error for a missing array, wrong types and shapes, arrays outside their block, indices
/// out of range and sizes that disagree. Unknown arrays are ignored.
Result assemble(Result answers, const BlockView& mesh_block, const BlockView& result_block);

}  // namespace anticrack::results
