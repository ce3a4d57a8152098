// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "cli/json.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"
#include "results/result.hpp"

namespace anticrack::cli {
namespace {

using results::Range;
using results::range_of;
using results::slope_range;

constexpr std::array<const char*, 2> slope_parts{"Bx", "By"};

// The name of a number: "A", or "A fibre" if there are several inclusions.
std::string name_of(const char* number, const results::Sweep& sweep, std::size_t inclusion) {
  return sweep.inclusions.size() == 1 ? number : number + (" " + sweep.inclusions[inclusion]);
}

// Rows that were cancelled, or not begun.
std::uint64_t not_solved(const v1::SweepAnswer& answer) {
  return answer.rows() - answer.converged() - answer.not_converged() - answer.failed();
}

std::string endings(const v1::SweepAnswer& answer) {
  std::string text = fmt::format("{} converged", answer.converged());
  const auto add = [&text](std::uint64_t count, const char* what) {
    text += count > 0 ? fmt::format(", {} {}", count, what) : std::string();
  };
  add(answer.not_converged(), "did not converge");
  add(answer.failed(), "failed");
  add(not_solved(answer), "were not solved");
  return text;
}

using Rows = std::vector<std::vector<std::string>>;

const std::vector<std::string> head_of_spans{"", "least", "of", "most", "of"};

// An end of a range to four digits, rounded outwards (`sign`: down or up).
std::string end_of(double value, int sign) {
  if (!std::isfinite(value) || value == 0) return number(value);
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3);
  const double shown = std::round(value / unit) * unit;
  return number(sign * (value - shown) > 1e-6 * unit ? shown + sign * unit : shown);
}

void add_span(const std::string& label, const Range& range, Rows& rows) {
  rows.push_back({label, end_of(range.low, -1), "", end_of(range.high, 1), ""});
}

bool tilts(const results::Sweep& sweep, std::size_t inclusion) {
  return slope_range(sweep, inclusion, 0).nonzero() || slope_range(sweep, inclusion, 1).nonzero();
}

void add_inclusions(const results::Sweep& sweep, const v1::Units& units, Rows& rows) {
  for (std::size_t i = 0; i < sweep.inclusions.size(); ++i) {
    add_span(results::labelled(name_of("A", sweep, i), units, "L"),
             range_of(sweep, "displacement", i, true), rows);
    for (std::size_t part = 0; part < slope_parts.size() && tilts(sweep, i); ++part)
      add_span(name_of(slope_parts[part], sweep, i), slope_range(sweep, i, part), rows);
  }
}

/// The table without the columns of names that are empty in all rows.
std::string table_of_spans(Rows rows) {
  for (const std::size_t column : {4U, 2U}) drop_if_empty(rows, column);
  const bool named = rows[0].size() == head_of_spans.size();
  return table(rows, named ? std::vector<std::size_t>{2, 4} : std::vector<std::size_t>{});
}

/// Adds the least and the greatest value of all inclusions, with the inclusions' names.
void add_extremes(const results::Sweep& sweep, const v1::Units& units, Rows& rows) {
  const std::size_t inclusions = sweep.inclusions.size();
  const auto add_one = [&](const char* name, const char* dimension, const auto& range_at) {
    std::vector<Range> ranges;
    for (std::size_t i = 0; i < inclusions; ++i) ranges.push_back(range_at(i));
    const auto least = std::ranges::min_element(ranges, {}, &Range::low),
               most = std::ranges::max_element(ranges, {}, &Range::high);
    const auto name_at = [&](auto place) {
      return sweep.inclusions[static_cast<std::size_t>(place - ranges.begin())];
    };
    rows.push_back(
        {results::labelled(fmt::format("{} of {} inclusions", name, inclusions), units, dimension),
         end_of(least->low, -1), name_at(least), end_of(most->high, 1), name_at(most)});
  };
  add_one("A", "L", [&](std::size_t i) { return range_of(sweep, "displacement", i, true); });
  bool tilted = false;
  for (std::size_t i = 0; i < inclusions; ++i) tilted = tilted || tilts(sweep, i);
  for (std::size_t part = 0; part < slope_parts.size() && tilted; ++part)
    add_one(slope_parts[part], "", [&](std::size_t i) { return slope_range(sweep, i, part); });
}

Json range_json(const Range& range) { return {{"min", range.low}, {"max", range.high}}; }

/// A text like "rows 3, 7, 12, 20, 21 and 4 more", with the rows for which `holds` is true.
template <class Holds>
std::string first_rows(const results::Sweep& sweep, const Holds& holds) {
  constexpr std::size_t most = 5;
  std::string rows;
  std::size_t count = 0;
  for (std::size_t row = 0; row < sweep.rows(); ++row) {
    if (!holds(row) || ++count > most) continue;
    rows += fmt::format("{}{}", count == 1 ? " " : ", ", row);
  }
  return (count == 1 ? "row" : "rows") + rows +
         (count > most ? fmt::format(" and {} more", count - most) : "");
}

/// A text like "bounds of 9 rows: of the energy at most 0.89 % wide, of A at most +- 0.0056".
std::string bounds_text(const results::Sweep& sweep, const v1::Units& units) {
  const auto lower = sweep.numbers("energy_lower");
  if (lower.empty()) return "";
  const results::Widths widths = widths_of(sweep);
  if (widths.rows == 0) return "no row has bounds\n";
  std::string text = "bounds of " + counted(widths.rows, "row") + ": of the energy at most " +
                     per_cent(widths.energy) + " wide";
  if (std::isfinite(widths.displacement))
    text += ", of A at most +- " + number(widths.displacement, 2) +
            sanitise(results::unit_behind(units, "L"));
  if (widths.rows < sweep.answer.converged()) {
    text += "; none of " + first_rows(sweep, [&](std::size_t row) {
              return sweep.converged(row) && std::isnan(lower[row]);
            });
  }
  return text + "\n";
}

/// The row in which a tip has its largest G, -1: in none.
struct Largest {
  double g = -1;
  std::int64_t row = -1;
};

std::vector<Largest> largest_rates(const results::Sweep& sweep) {
  std::vector<Largest> found(sweep.tips());
  const auto rates = sweep.numbers("energy_release_rate");
  for (std::size_t row = 0; row < sweep.rows(); ++row) {
    for (std::size_t tip = 0; tip < found.size(); ++tip) {
      const double g = rates[row * found.size() + tip];
      if (sweep.converged(row) && g > found[tip].g)
        found[tip] = {g, static_cast<std::int64_t>(row)};
    }
  }
  return found;
}

/// A text like "largest G of tip 1: 0.23 in row 17" for each tip that has one.
std::string tips_text(const results::Sweep& sweep, const v1::Units& units) {
  std::string text;
  const std::vector<Largest> found = largest_rates(sweep);
  for (std::size_t tip = 0; tip < found.size(); ++tip)
    if (found[tip].row >= 0)
      text += fmt::format("largest {} of tip {}: {} in row {}\n",
                          sanitise(results::labelled("G", units, "F")), tip,
                          number(found[tip].g, 5), found[tip].row);
  return text;
}

/// A column of comma-separated text: in each row the number at `place` of `width`.
struct CsvColumn {
  std::string title;
  std::span<const double> values;
  std::size_t width = 1, place = 0;
};

/// The columns of numbers that are right only where a row converged.
std::vector<CsvColumn> csv_columns(const results::Sweep& sweep) {
  std::vector<CsvColumn> columns;
  const auto add = [&](std::string title, std::string_view name, std::size_t width = 1,
                       std::size_t place = 0) {
    if (const auto values = sweep.numbers(name); !values.empty())
      columns.push_back({std::move(title), values, width, place});
  };
  const std::size_t inclusions = sweep.inclusions.size(), tips = sweep.tips();
  for (std::size_t i = 0; i < inclusions; ++i) {
    for (const std::string end : {"", "_lower", "_upper", "_mesh"})
      add(name_of(("A" + end).c_str(), sweep, i), "displacement" + end, inclusions, i);
    for (std::size_t part = 0; part < slope_parts.size(); ++part)
      add(name_of(slope_parts[part], sweep, i), "slope", 2 * inclusions, 2 * i + part);
  }
  for (std::size_t tip = 0; tip < tips; ++tip) {
    add(fmt::format("intensity of tip {}", tip), "intensity", tips, tip);
    add(fmt::format("G of tip {}", tip), "energy_release_rate", tips, tip);
    add(fmt::format("G_spread of tip {}", tip), "energy_release_rate_spread", tips, tip);
  }
  for (const char* name :
       {"energy", "energy_lower", "energy_upper", "energy_mesh", "contact_length"})
    add(name, name);
  return columns;
}

}  // namespace

std::string worst_of(const v1::SweepAnswer& answer) {
  return "at most " + counted(static_cast<std::size_t>(answer.most_steps()), "step") +
         ", KKT residuals at most " + number(answer.worst_kkt(), 2);
}

std::string sweep_table(const results::Sweep& sweep, const v1::Units& units) {
  std::string text = counted(sweep.rows(), "row");
  if (!sweep.source.empty()) text += " of " + sanitise(sweep.source);
  text += ": " + endings(sweep.answer);
  const std::uint64_t converged = sweep.answer.converged();
  if (converged > 0 && converged < sweep.rows())
    text += " (" + first_rows(sweep, [&](std::size_t row) { return !sweep.converged(row); }) + ")";
  text += "\n";
  if (converged > 0) {
    text += worst_of(sweep.answer) + "\n\n";
    Rows rows{head_of_spans};
    if (sweep.inclusions.size() > few_inclusions)
      add_extremes(sweep, units, rows);
    else
      add_inclusions(sweep, units, rows);
    const auto [shortest, longest] = range_of(sweep, "contact_length");
    rows.push_back({results::labelled("contact length", units, "L"), contact_text(shortest), "",
                    contact_text(longest), ""});
    add_span(results::labelled("energy", units, "F L"), range_of(sweep, "energy", 0, true), rows);
    text += table_of_spans(std::move(rows));
    if (sweep.inclusions.size() > few_inclusions)
      text += "all inclusions: anticrack show RESULT --inclusions, or --csv FILE\n";
  }
  text += bounds_text(sweep, units) + tips_text(sweep, units);
  if (const std::size_t kept = sweep.integers("kept").size(); kept > 0)
    text += "traces of " + counted(kept, "row") + "\n";
  if (!sweep.error.empty()) text += sanitise(sweep.error) + "\n";
  return text;
}

std::string sweep_inclusions(const results::Sweep& sweep, const v1::Units& units) {
  Rows rows{head_of_spans};
  if (sweep.answer.converged() > 0) add_inclusions(sweep, units, rows);
  return rows.size() == 1 ? "no inclusions\n" : table_of_spans(std::move(rows));
}

Json sweep_json(const results::Sweep& sweep) {
  Json inclusions = Json::array();
  for (std::size_t i = 0; i < sweep.inclusions.size(); ++i) {
    Json inclusion{{"name", sweep.inclusions[i]},
                   {"A", range_json(range_of(sweep, "displacement", i))}};
    for (std::size_t part = 0; part < slope_parts.size(); ++part)
      inclusion[slope_parts[part]] = range_json(slope_range(sweep, i, part));
    inclusions.push_back(std::move(inclusion));
  }
  Json tips = Json::array();
  for (const Largest& tip : largest_rates(sweep))
    tips.push_back({{"G", tip.row < 0 ? results::unknown : tip.g}, {"row", tip.row}});
  const results::Widths widths = widths_of(sweep);
  Json json = json_of(sweep.answer);
  json.update({{"source", sweep.source},
               {"not_solved", not_solved(sweep.answer)},
               {"error", sweep.error},
               {"loads", sweep.loads},
               {"inclusions", std::move(inclusions)},
               {"tips", std::move(tips)},
               {"contact_length", range_json(range_of(sweep, "contact_length"))},
               {"energy", range_json(range_of(sweep, "energy"))},
               {"bounded", widths.rows},
               {"energy_width", widths.energy},
               {"displacement_error", widths.displacement}});
  return json;
}

std::string sweep_csv(const results::Sweep& sweep) {
  const auto coefficients = sweep.numbers("coefficients");
  const auto status = sweep.status(), steps = sweep.integers("steps");
  const std::size_t loads = coefficients.empty() ? 0 : sweep.loads.size();
  const std::vector<CsvColumn> columns = csv_columns(sweep);
  std::string text = "row";
  for (std::size_t i = 0; i < loads; ++i) text += "," + csv_field(sweep.loads[i]);
  for (const CsvColumn& column : columns) text += "," + csv_field(column.title);
  text += ",steps,status\n";
  for (std::size_t row = 0; row < status.size(); ++row) {
    const bool converged = status[row] == v1::LoadCaseAnswer::STATUS_CONVERGED;
    text += std::to_string(row);
    for (std::size_t i = 0; i < loads; ++i) text += "," + exact(coefficients[row * loads + i]);
    for (const CsvColumn& column : columns)
      text += "," +
              (converged ? exact(column.values[row * column.width + column.place]) : std::string());
    text += fmt::format(",{},{}\n", steps[row], results::status_name(status[row]));
  }
  return text;
}

}  // namespace anticrack::cli
