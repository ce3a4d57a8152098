// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "records/block.hpp"
#include "store/spool.hpp"

namespace anticrack::jobs {

/// Arrays of a result, and where in the job's spool their bytes are.
struct ResultPart {
  std::vector<records::ArrayLayout> arrays;
  store::Spool::Run run;
};

/// Puts the block's bytes into the spool.
inline ResultPart spooled(store::Spool& spool, records::Block block) {
  const store::Spool::Run run = spool.append(block.bytes);
  return {std::move(block.arrays), run};
}

}  // namespace anticrack::jobs
