// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes a Result of the two binary blocks of the server (ReadMesh, ReadResult).
#pragma once

#include <cstddef>
#include <span>

#include "anticrack/v1/mesh.pb.h"
#include "results/result.hpp"

namespace anticrack::results {

/// A whole block, and the layout of the arrays in it.
struct BlockView {
  const v1::BlockLayout& layout;
  std::span<const std::byte> bytes;
};

/// Adds the arrays to a Result made of the server's messages.
///
/// `answers` has everything but arrays. The mesh is filled in from `mesh_block`, interfaces from
/// both, loads[].traces, history, fields and indicator from `result_block`. A load may lack
/// arrays unless it is `converged` or `not_converged`.
/// For a sweep `answers` has no loads, but sweep.loads, inclusions, kept and answer; the columns
/// are filled in, and a load is added for every kept row (see Sweep::kept).
///
/// Throws Error for a missing array, wrong types and shapes, arrays outside their block, and what
/// first_fault finds. Unknown arrays are ignored.
Result assemble(Result answers, const BlockView& mesh_block, const BlockView& result_block);

}  // namespace anticrack::results
