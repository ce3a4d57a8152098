// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result the seeds of result_stream are of: tests/support's, small.
#pragma once

#include "support/sample_result.hpp"

namespace anticrack::fuzz {

inline results::Result small_result() {
  results::Result result = testing::sample_result(1);
  for (auto& load : result.loads) {
    auto& history = load.history;
    history.iteration.resize(2);
    for (auto* values : {&history.criterion, &history.energy, &history.kkt.equilibrium,
                         &history.kkt.gap, &history.kkt.sign, &history.kkt.complementarity}) {
      values->resize(2);
    }
    history.contact_count.resize(2);
    load.answer.set_iterations(2);
  }
  return result;
}

}  // namespace anticrack::fuzz
