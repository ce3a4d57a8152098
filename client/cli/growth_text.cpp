// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/growth_text.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "cli/text.hpp"
#include "results/entries.hpp"

namespace anticrack::cli {
namespace {

constexpr std::array columns{"position", "load", "displacement", "G1", "Gc", "contact_length"};

/// Whether the row begins or ends something: it is the first or last, or the fronts run from there
/// or to there, or another front leads.
bool is_turn(const v1::LoadCaseAnswer& answer, int row) {
  if (row == 0 || row + 1 == answer.growth_size()) return true;
  const v1::GrowthRow &before = answer.growth(row - 1), &here = answer.growth(row),
                      &after = answer.growth(row + 1);
  return here.stable() != before.stable() || here.stable() != after.stable() ||
         here.interface() != before.interface();
}

}  // namespace

std::string growth_table(const std::vector<results::Load>& loads, const v1::Units& units,
                         bool all) {
  std::vector<std::vector<std::string>> rows{{"load case", "row", "front"}, {"", "", ""}};
  for (const char* const name : columns) {
    const results::Entry& entry = *results::entry_of(*v1::GrowthRow::descriptor(), name);
    rows[0].push_back(entry.name == "contact_length" ? "contact length" : entry.name);
    rows[1].push_back(sanitise(results::unit_of(units, entry.unit)));
  }
  rows[0].emplace_back("stable");
  rows[1].emplace_back("");
  std::string notes;
  bool left_out = false;
  for (const results::Load& load : loads) {
    const v1::LoadCaseAnswer& answer = load.answer;
    for (int i = 0; i < answer.growth_size(); ++i) {
      if (!all && answer.growth_size() > few_rows && !is_turn(answer, i)) {
        left_out = true;
        continue;
      }
      const v1::GrowthRow& row = answer.growth(i);
      auto& cells = rows.emplace_back(std::vector{
          sanitise(load.name()), std::to_string(i),
          row.front() < 0 ? "all closed"
                          : fmt::format("{} {}", row.front(), sanitise(row.interface()))});
      for (const char* const name : columns) {
        const double value = results::number_in(row, name);
        cells.push_back(std::isfinite(value) ? number(value, 5) : "-");
      }
      cells.emplace_back(row.stable() ? "yes" : "no");
    }
    for (const std::string& note : answer.growth_notes())
      notes += sanitise(load.name()) + ": " + sanitise(note) + "\n";
  }
  if (rows.size() == 2) return "";
  return "\n" + table(rows, {2, 9}) +
         (left_out ? "all rows: anticrack show RESULT --growth\n" : "") + notes;
}

}  // namespace anticrack::cli
