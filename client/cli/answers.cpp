// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cli/json.hpp"
#include "cli/progress.hpp"
#include "cli/text.hpp"
#include "results/entries.hpp"
#include "results/result.hpp"

namespace anticrack::cli {
namespace {

struct Moved {
  std::string name;
  bool tilted = false;  // in at least one of the loads
};

// All inclusions, without repetition, in the order of the loads.
std::vector<Moved> inclusions_of(const std::vector<results::Load>& loads) {
  std::vector<Moved> all;
  std::map<std::string_view, std::size_t> places;
  for (const results::Load& load : loads) {
    for (const v1::InclusionAnswer& inclusion : load.answer.inclusions()) {
      const auto [place, is_new] = places.try_emplace(inclusion.name(), all.size());
      if (is_new) all.push_back({inclusion.name()});
      all[place->second].tilted |= inclusion.slope_x() != 0 || inclusion.slope_y() != 0;
    }
  }
  return all;
}

bool any_tilts(const std::vector<Moved>& inclusions) {
  return std::ranges::any_of(inclusions, &Moved::tilted);
}

// The error of A in parentheses: " (0.85 %)" of itself unless it may be 0, and where it is nearer
// to 0 " (40 %; 0.3 % of 0.0512)", of its scale.
std::string error_of_a(const v1::InclusionAnswer& inclusion) {
  const double lower = inclusion.displacement_lower(), upper = inclusion.displacement_upper(),
               own = 0.5 * (upper - lower) / std::abs(inclusion.displacement());
  std::string text = lower <= 0 && upper >= 0 ? "" : per_cent(own);
  if (inclusion.displacement_error_relative() < own) {
    text += (text.empty() ? "" : "; ") + per_cent(inclusion.displacement_error_relative()) +
            " of " + number(inclusion.displacement_scale(), 3);
  }
  return text.empty() ? "" : " (" + text + ")";
}

// ", probably 0.015715 +- 1.2e-05", where the estimate says more than the bounds.
std::string probable_error(const v1::InclusionAnswer& inclusion) {
  const double proved = 0.5 * (inclusion.displacement_upper() - inclusion.displacement_lower());
  const double probable = inclusion.displacement_mesh() + inclusion.displacement_estimated_error();
  return inclusion.has_displacement_error_probable() &&
                 inclusion.displacement_error_probable() < proved
             ? ", probably " + results::interval(probable,
                                                 probable - inclusion.displacement_error_probable(),
                                                 probable + inclusion.displacement_error_probable())
             : "";
}

// ", chords +- 1.2e-05": what curves in place of their chords may change, by estimate.
std::string of_chords(bool has, double error) {
  return has ? ", chords +- " + number(error, 2) : "";
}

// A number with its bounds, if it has them, and of A with its relative error.
std::string text_of(const v1::InclusionAnswer& inclusion, const std::string& number_name) {
  const double value = results::number_in(inclusion, number_name),
               lower = results::number_in(inclusion, number_name + "_lower");
  if (!std::isfinite(lower)) return number(value);
  const bool of_a = number_name == "A" && inclusion.has_displacement_error_relative();
  return results::interval(value, lower, results::number_in(inclusion, number_name + "_upper")) +
         (of_a ? error_of_a(inclusion) + probable_error(inclusion) +
                     of_chords(inclusion.has_displacement_geometry_error(),
                               inclusion.displacement_geometry_error())
               : "");
}

// The numbers to show for an inclusion: only A, if it never tilts.
std::span<const std::string> told_of(const Moved& inclusion) {
  static const std::array<std::string, 5> names{"A", "Bx", "By", "Mx", "My"};
  return std::span(names).first(inclusion.tilted ? names.size() : 1);
}

std::string dimension_of(const std::string& number_name) {
  return results::entry_of(*v1::InclusionAnswer::descriptor(), number_name)->unit;
}

// The head of a column; without a dimension its second row is empty.
struct Head {
  std::string name;
  std::optional<std::string> dimension{};
};

// The part of the table about inclusions: each of them or, for many, the range of their motions.
class Told {
 public:
  explicit Told(std::vector<Moved> inclusions)
      : _inclusions(std::move(inclusions)), _tilt(any_tilts(_inclusions)) {}

  bool each() const { return _inclusions.size() <= few_inclusions; }

  // Names of columns with their dimensions.
  std::vector<Head> head() const {
    std::vector<Head> head;
    for (const Moved& inclusion : _inclusions) {
      if (!each()) break;
      for (const std::string& name : told_of(inclusion)) {
        head.push_back({name, dimension_of(name)});
        if (_inclusions.size() > 1) head.back().name += " " + inclusion.name;
      }
    }
    if (each()) return head;
    head = {{"inclusions", ""}, {"least A", "L"}, {of}, {"greatest A", "L"}, {of}};
    if (_tilt) head.insert(head.end(), {{"greatest |B|", ""}, {of}});
    return head;
  }

  void add(const results::Load& load, std::vector<std::string>& row) const {
    if (!each()) return add_extremes(load, row);
    for (const Moved& inclusion : _inclusions) {
      const auto& all = load.answer.inclusions();
      const auto found = std::ranges::find(all, inclusion.name, &v1::InclusionAnswer::name);
      const bool told = load.has_answer() && found != all.end();
      for (const std::string& name : told_of(inclusion))
        row.push_back(told ? text_of(*found, name) : "-");
    }
  }

  // The hint below the table.
  std::string hint() const {
    if (each()) return "";
    return fmt::format("all {} inclusions: anticrack show RESULT --inclusions, or --csv FILE\n",
                       _inclusions.size());
  }

  static constexpr const char* of = "of";  // heads a column of names

 private:
  void add_extremes(const results::Load& load, std::vector<std::string>& row) const {
    const auto& all = load.answer.inclusions();
    if (!load.has_answer() || all.empty()) {
      row.insert(row.end(), {"-", "-", "", "-", ""});
      if (_tilt) row.insert(row.end(), {"-", ""});
      return;
    }
    constexpr std::size_t widest_name = 24;
    const auto add_one = [&row](const v1::InclusionAnswer& inclusion, std::string value) {
      row.insert(row.end(), {std::move(value), fit(sanitise(inclusion.name()), widest_name)});
    };
    row.push_back(std::to_string(all.size()));
    const auto [least, greatest] =
        std::ranges::minmax_element(all, {}, &v1::InclusionAnswer::displacement);
    add_one(*least, text_of(*least, "A"));
    add_one(*greatest, text_of(*greatest, "A"));
    if (!_tilt) return;
    const auto slope = [](const v1::InclusionAnswer& inclusion) {
      return std::hypot(inclusion.slope_x(), inclusion.slope_y());
    };
    const auto steepest = std::ranges::max_element(all, {}, slope);
    add_one(*steepest, number(slope(*steepest)));
  }

  std::vector<Moved> _inclusions;
  bool _tilt;
};

bool is_bounded(const results::Load& load) {
  return load.has_answer() && load.answer.has_error_bound();
}

std::vector<std::string> row_of(const results::Load& load, const Told& inclusions, bool by_uzawa,
                                bool bounded) {
  const v1::LoadCaseAnswer& answer = load.answer;
  const bool answered = load.has_answer();
  const auto when_answered = [answered](double value, int digits = 6, bool exponent = false) {
    return answered ? number(value, digits, exponent) : "-";
  };
  std::vector<std::string> row{
      load.name(), std::string(word(answer.status())), std::to_string(answer.iterations()),
      when_answered(by_uzawa ? answer.criterion() : results::largest_kkt(answer), 2, true)};
  inclusions.add(load, row);
  row.push_back(
      answered && answer.has_energy_lower()
          ? results::interval(answer.energy(), answer.energy_lower(), answer.energy_upper()) +
                of_chords(answer.has_energy_geometry_error(), answer.energy_geometry_error())
          : when_answered(answer.energy()));
  if (bounded) {
    const double error = results::number_in(answer, "error_bound_relative");
    row.push_back(when_answered(100 * error, error < 1 ? 2 : 3));
  }
  row.push_back(answered ? contact_text(answer.contact_length()) : "-");
  if (by_uzawa) {
    row.push_back(when_answered(results::number_in(answer, "theta"), 4));
    row.push_back(when_answered(results::number_in(answer, "theta_star"), 4));
  }
  row.push_back(seconds(results::number_in(answer, "solve_seconds")));
  return row;
}

// The lines below the table.
std::vector<std::string> remarks_on(const results::Load& load) {
  const v1::LoadCaseAnswer& answer = load.answer;
  std::vector<std::string> remarks;
  const std::string& failure = answer.error().message();
  if (const std::string& cause = failure.empty() ? answer.reason() : failure; !cause.empty())
    remarks.push_back(cause);
  if (answer.weakly_active() > 0) {
    remarks.push_back(
        fmt::format("{}{}: neither jump nor pressure", answer.weakly_active(),
                    answer.weakly_active() == 1 ? " node just touches" : " nodes just touch"));
  }
  for (const std::string& warning : answer.warnings()) remarks.push_back("warning: " + warning);
  if (!answer.no_bracket().empty())
    remarks.push_back("no bounds of the error: " + answer.no_bracket());
  constexpr double small_error = 0.01;
  const bool in_stages = !load.stages.empty();  // the accuracy was chosen
  const double error = results::number_in(answer, "error_bound_relative");
  if (is_bounded(load) && answer.error_bound() > 0 && !std::isfinite(error) && !in_stages)
    remarks.push_back(
        "u is 0 on this mesh, but need not be on the membrane; take a smaller mesh.size");
  if (is_bounded(load) && std::isfinite(error) && error > small_error && !in_stages)
    remarks.push_back("u is within " + per_cent(error) +
                      " of the membrane's in the energy norm; for less write "
                      "[accuracy] energy = 1e-3, or smaller");
  return remarks;
}

Json load_json(const results::Load& load, const std::string& method) {
  Json json = with_lists(load.answer, json_of(load.answer));
  json["method"] = method;
  json["worst_kkt"] = load.has_answer() ? results::largest_kkt(load.answer) : results::unknown;
  json["stages"] = Json::array();
  for (const v1::Stage& stage : load.stages)
    json["stages"].push_back(json_of(stage.answers(0), json_of(stage)));
  return json;
}

}  // namespace

std::string answers_table(const std::vector<results::Load>& loads, const v1::Units& units) {
  const Told inclusions(inclusions_of(loads));
  const bool by_uzawa = std::any_of(loads.begin(), loads.end(), [](const results::Load& load) {
    return load.answer.has_theta();
  });
  std::vector<Head> head{
      {"load"}, {"status"}, {"iterations", ""}, {by_uzawa ? "criterion" : "KKT", ""}};
  std::ranges::move(inclusions.head(), std::back_inserter(head));
  const bool bounded = std::ranges::any_of(loads, is_bounded);
  head.push_back({"energy", "F L"});
  if (bounded) head.push_back({"error of u", "%"});
  head.push_back({"contact length", "L"});
  if (by_uzawa) head.insert(head.end(), {{"theta", ""}, {"theta*", ""}});
  head.push_back({"wall time", "s"});
  std::vector<std::size_t> left{1};
  std::vector<std::vector<std::string>> rows(2);
  for (const Head& column : head) {
    if (column.name == Told::of) left.push_back(rows[0].size());
    rows[0].push_back(column.name);
    rows[1].push_back(column.dimension ? results::unit_of(units, *column.dimension) : "");
  }
  std::string remarks;
  for (const results::Load& load : loads) {
    rows.push_back(row_of(load, inclusions, by_uzawa, bounded));
    for (const std::string& remark : remarks_on(load))
      remarks += sanitise(load.name()) + ": " + sanitise(remark) + "\n";
  }
  return table(rows, left) + inclusions.hint() + remarks + tips_table(loads, units, false) +
         growth_table(loads, units, false);
}

std::string answers_table(const results::Result& result) {
  std::string text = result.sweep ? sweep_table(*result.sweep, result.units)
                                  : answers_table(result.loads, result.units);
  for (const std::string& note : results::notes_on(result))
    text += "note: " + sanitise(note) + "\n";
  return text;
}

std::string inclusions_table(const results::Result& result) {
  if (result.sweep) return sweep_inclusions(*result.sweep, result.units);
  const auto columns = told_of({"", any_tilts(inclusions_of(result.loads))});
  std::vector<std::vector<std::string>> rows{{"load", "inclusion"}, {"", ""}};
  for (const std::string& name : columns) {
    rows[0].push_back(name);
    rows[1].push_back(results::unit_of(result.units, dimension_of(name)));
  }
  rows[0].insert(rows[0].end(), {"resultant", "contact length"});
  rows[1].insert(rows[1].end(),
                 {results::unit_of(result.units, "F"), results::unit_of(result.units, "L")});
  for (const results::Load& load : result.loads) {
    if (!load.has_answer()) continue;
    for (const v1::InclusionAnswer& inclusion : load.answer.inclusions()) {
      auto& row = rows.emplace_back(std::vector{load.name(), inclusion.name()});
      for (const std::string& name : columns) row.push_back(text_of(inclusion, name));
      row.insert(row.end(),
                 {number(inclusion.resultant()), contact_text(inclusion.contact_length())});
    }
  }
  return rows.size() == 2 ? "no inclusions\n" : table(rows, {1});
}

std::string answers_csv(const results::Result& result) {
  if (result.sweep) return sweep_csv(*result.sweep);
  const auto& columns = results::entries_of(*v1::InclusionAnswer::descriptor());
  std::string text = "load,inclusion";
  for (const results::Entry& column : columns)
    if (column.type == results::ValueType::float64) text += "," + column.name;
  text += '\n';
  for (const results::Load& load : result.loads) {
    if (!load.has_answer()) continue;
    for (const v1::InclusionAnswer& inclusion : load.answer.inclusions()) {
      text += csv_field(load.name()) + "," + csv_field(inclusion.name());
      for (const results::Entry& column : columns)
        if (column.type == results::ValueType::float64)
          text += "," + exact(std::get<double>(results::get(inclusion, column)));
      text += '\n';
    }
  }
  return text;
}

std::string numbers_table(const results::Result& result) {
  std::string text;
  const auto add = [&](const std::string& of, const google::protobuf::Message& message) {
    std::vector<std::vector<std::string>> rows;
    for (const results::Entry& entry : results::entries_of(*message.GetDescriptor())) {
      if (entry.type == results::ValueType::text) continue;
      rows.push_back({entry.name, text_of(results::get(message, entry)),
                      results::unit_of(result.units, entry.unit), entry.meaning});
    }
    text += "\n" + sanitise(of) + ", every number:\n" + table(rows, {2, 3});
  };
  add(result.mesh.name(), result.mesh);
  if (result.sweep) add("sweep", result.sweep->answer);
  for (const results::Load& load : result.loads) add(load.name(), load.answer);
  return text;
}

std::string answers_json(const results::Result& result, const std::filesystem::path& file) {
  Json json{{"title", result.title},
            {"file", file.string()},
            {"job", result.job_name},
            {"mesh", json_of(result.mesh)},
            {"units", json_of(result.units)},
            {"solve_seconds", results::solve_seconds(result)},
            {"total_seconds", result.total_seconds},
            {"not_reached", result.not_reached},
            {"notes", results::notes_on(result)}};
  if (result.sweep) json["sweep"] = sweep_json(*result.sweep);
  Json& answers = json["answers"] = Json::array();
  for (const results::Load& load : result.loads)
    answers.push_back(load_json(load, result.solver.has_uzawa() ? "uzawa" : "active-set"));
  return to_text(json);
}

}  // namespace anticrack::cli
