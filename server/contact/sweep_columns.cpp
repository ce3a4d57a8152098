// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/sweep_columns.hpp"

#include <limits>

#include "contact/answer.hpp"

namespace anticrack::contact {

void SweepColumns::take_bounds(std::size_t row, const AnswerSummary& answer) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  energy_mesh[row] = energy[row];
  energy[row] = middle_or(energy[row], answer.energy_lower, answer.energy_upper);
  energy_lower[row] = answer.energy_lower.value_or(none);
  energy_upper[row] = answer.energy_upper.value_or(none);
  for (std::size_t i = 0; i < inclusions; ++i) {
    const InclusionAnswer& inclusion = answer.inclusions[i];
    const std::size_t place = row * inclusions + i;
    const std::optional<double>&lower = inclusion.displacement_lower,
          &upper = inclusion.displacement_upper;
    displacement_mesh[place] = displacement[place];
    displacement[place] = middle_or(displacement[place], lower, upper);
    displacement_lower[place] = lower.value_or(none);
    displacement_upper[place] = upper.value_or(none);
  }
}

void SweepColumns::take_tip(std::size_t row, std::size_t tip, const TipAnswer& answer) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t place = row * tips + tip;
  intensity[place] = answer.intensity.value_or(none);
  energy_release_rate[place] = answer.energy_release_rate.value_or(none);
  energy_release_rate_spread[place] = answer.energy_release_rate_spread.value_or(none);
}

}  // namespace anticrack::contact
