// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/stages_text.hpp"

#include <algorithm>
#include <vector>

#include "cli/text.hpp"
#include "results/entries.hpp"
#include "results/interval.hpp"

namespace anticrack::cli {

std::string stages_table(const results::Load& load) {
  if (load.stages.empty()) return "";
  const bool of_a = std::ranges::any_of(load.stages, [](const v1::Stage& stage) {
    return stage.answers(0).has_displacement_error();
  });
  std::vector<std::vector<std::string>> rows{{"stage", "triangles", "energy", "error of u"},
                                             {"", "-", "-", "%"}};
  if (of_a) {
    rows[0].emplace_back("error of A");
    rows[1].emplace_back("%");
  }
  rows[0].emplace_back("time");
  rows[1].emplace_back("s");
  for (std::size_t i = 0; i < load.stages.size(); ++i) {
    const v1::Stage& stage = load.stages[i];
    const v1::StageAnswer& answer = stage.answers(0);
    const auto per_cent_of = [&answer](const char* name) {
      return number(100 * results::number_in(answer, name), 2);
    };
    auto& row = rows.emplace_back(std::vector{
        std::to_string(i + 1), std::to_string(stage.triangles()),
        answer.has_energy_lower()
            ? results::interval(answer.energy(), answer.energy_lower(), answer.energy_upper())
            : number(answer.energy()),
        per_cent_of("error_bound_relative")});
    if (of_a) row.push_back(per_cent_of("displacement_error"));
    row.push_back(seconds(stage.seconds()));
  }
  return "\n" + sanitise(load.name()) + ", stage by stage:\n" + table(rows);
}

}  // namespace anticrack::cli
