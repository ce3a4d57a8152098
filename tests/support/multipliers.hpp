// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "contact/traces.hpp"

namespace anticrack::testing {

/// mu in each node, whether it is the pressure of a contact or a flux.
inline std::vector<double> multipliers(const contact::Trace& trace) {
  std::vector<double> mu = trace.pressure;
  for (std::size_t i = 0; i < mu.size(); ++i) mu[i] += trace.flux[i];
  return mu;
}

}  // namespace anticrack::testing
