// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stages_text.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/text.hpp"
#include "results/interval.hpp"

namespace anticrack::cli {

std::string stages_table(const results::Load& load) {
  const results::Stages& stages = load.stages;
  if (stages.size() == 0) return "";
  const bool of_a = std::ranges::any_of(stages.displacement_error,
                                        [](double error) { return std::isfinite(error); });
  std::vector<std::vector<std::string>> rows{{"stage", "triangles", "energy", "error of u"},
                                             {"", "-", "-", "%"}};
  if (of_a) {
    rows[0].emplace_back("error of A");
    rows[1].emplace_back("%");
  }
  rows[0].emplace_back("time");
  rows[1].emplace_back("s");
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double lower = stages.energy_lower[i], upper = stages.energy_upper[i];
    auto& row = rows.emplace_back(std::vector{
        std::to_string(i + 1), std::to_string(stages.triangles[i]),
        std::isfinite(lower) ? results::interval(lower, upper) : number(stages.energy[i]),
        number(100 * stages.error_bound_relative[i], 2)});
    if (of_a) row.push_back(number(100 * stages.displacement_error[i], 2));
    row.push_back(seconds(stages.seconds[i]));
  }
  return "\n" + sanitise(load.name) + ", stage by stage:\n" + table(rows);
}

}  // namespace anticrack::cli
