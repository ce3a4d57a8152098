// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "records/block.hpp"
#include "store/spool.hpp"

namespace anticrack::jobs {

/// Arrays of a result, and the place of their bytes in the job's spool.
struct ResultPart {
  std::vector<records::ArrayLayout> arrays;
  store::Spool::Run run;
};

/// Writes the block's bytes to the spool.
inline ResultPart spooled(store::Spool& spool, records::Block block) {
  const store::Spool::Run run = spool.append(block.bytes);
  return {std::move(block.arrays), run};
}

}  // namespace anticrack::jobs
