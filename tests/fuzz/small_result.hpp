// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result the seeds of result_stream are of: tests/support's, small.
#pragma once

#include "support/sample_result.hpp"

namespace anticrack::fuzz {

inline results::Result small_result() {
  results::Result result = testing::sample_result(1);
  for (auto& load : result.loads) {
    load.answer.set_iterations(2);
    for (const auto& row : results::tables::history)
      result.arrays.at(results::load_path(load.name()) + "history/" + std::string(row.name))
          .shape = {2};
  }
  return result;
}

}  // namespace anticrack::fuzz
