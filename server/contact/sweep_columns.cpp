// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/sweep_columns.hpp"

#include <limits>

#include "contact/answer.hpp"

namespace anticrack::contact {

void SweepColumns::take_bounds(std::size_t row, const AnswerSummary& answer) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  energy_lower[row] = answer.energy_lower.value_or(none);
  energy_upper[row] = answer.energy_upper.value_or(none);
  for (std::size_t i = 0; i < inclusions; ++i) {
    const InclusionAnswer& inclusion = answer.inclusions[i];
    displacement_lower[row * inclusions + i] = inclusion.displacement_lower.value_or(none);
    displacement_upper[row * inclusions + i] = inclusion.displacement_upper.value_or(none);
  }
}

}  // namespace anticrack::contact
