// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes a Result of the two binary blocks of the server (ReadMesh, ReadResult).
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "results/result.hpp"

namespace anticrack::results {

/// A whole block, and the layout of the arrays in it.
struct BlockView {
  const v1::BlockLayout& layout;
  std::shared_ptr<const std::vector<std::byte>> bytes;
};

/// Adds the arrays to a Result made of the server's messages; they share the bytes of the blocks.
///
/// `answers` has everything but arrays. A load may lack them unless it is `converged` or
/// `not_converged`. For a sweep `answers` has no loads, but sweep.loads, inclusions and answer, and
/// `kept` are the rows whose traces were asked for: a load is added for each that has them.
///
/// Throws Error for a missing array, wrong types and shapes, arrays outside their block, and what
/// first_fault finds. Unknown arrays are ignored.
Result assemble(Result answers, const BlockView& mesh_block, const BlockView& result_block,
                const std::vector<std::int32_t>& kept = {});

}  // namespace anticrack::results
