// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/growth_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cli/text.hpp"
#include "results/entries.hpp"

namespace anticrack::cli {
namespace {

constexpr std::array columns{"position", "load", "displacement", "G1", "Gc", "contact_length"};

constexpr std::array final_columns{"position", "load",     "load_lower", "load_upper",
                                   "G1",       "G1_final", "G1_lower",   "G1_upper"};

/// The first two rows of a table: what the columns are, and their units.
template <std::size_t n>
std::vector<std::vector<std::string>> head_of(const std::array<const char*, n>& names,
                                              const v1::Units& units) {
  std::vector<std::vector<std::string>> rows{{"load case", "row", "front"}, {"", "", ""}};
  for (const char* const name : names) {
    const results::Entry& entry = *results::entry_of(*v1::GrowthRow::descriptor(), name);
    std::string shown = entry.name;
    std::ranges::replace(shown, '_', ' ');
    rows[0].push_back(std::move(shown));
    rows[1].push_back(sanitise(results::unit_of(units, entry.unit)));
  }
  return rows;
}

template <std::size_t n>
std::vector<std::string> cells_of(const results::Load& load, int number,
                                  const std::array<const char*, n>& names) {
  const v1::GrowthRow& row = load.answer.growth(number);
  std::vector<std::string> cells{
      sanitise(load.name()), std::to_string(number),
      row.front() < 0 ? "all closed"
                      : fmt::format("{} {}", row.front(), sanitise(row.interface()))};
  for (const char* const name : names) {
    const double value = results::number_in(row, name);
    cells.push_back(std::isfinite(value) ? cli::number(value, 5) : "-");
  }
  return cells;
}

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
  std::vector<std::vector<std::string>> rows = head_of(columns, units),
                                        bounds = head_of(final_columns, units);
  rows[0].emplace_back("stable");
  rows[1].emplace_back("");
  std::string notes;
  bool left_out = false;
  for (const results::Load& load : loads) {
    const v1::LoadCaseAnswer& answer = load.answer;
    for (int i = 0; i < answer.growth_size(); ++i) {
      const v1::GrowthRow& row = answer.growth(i);
      if (row.has_g1_final() || row.has_energy_lower())
        bounds.push_back(cells_of(load, i, final_columns));
      if (!all && answer.growth_size() > few_rows && !is_turn(answer, i)) {
        left_out = true;
        continue;
      }
      rows.push_back(cells_of(load, i, columns));
      rows.back().emplace_back(row.stable() ? "yes" : "no");
    }
    for (const std::string& note : answer.growth_notes())
      notes += sanitise(load.name()) + ": " + sanitise(note) + "\n";
  }
  if (rows.size() == 2) return "";
  return "\n" + table(rows, {2, 9}) +
         (left_out ? "all rows: anticrack show RESULT --growth\n" : "") +
         (bounds.size() > 2 ? "\non meshes of their own, with bounds of the means to the next\n" +
                                  table(bounds, {2, 10}) + "\n"
                            : "") +
         notes;
}

}  // namespace anticrack::cli
