// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/answers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cli/json.hpp"
#include "cli/progress.hpp"
#include "cli/sweep_text.hpp"
#include "cli/text.hpp"
#include "results/interval.hpp"
#include "results/notes.hpp"
#include "results/tables.hpp"

namespace anticrack::cli {
namespace {

bool has_answer(const results::Load& load) {
  return load.status == results::Status::converged || load.status == results::Status::not_converged;
}

struct Moved {
  std::string name;
  bool tilted = false;  // in one of the loads at least
};

// All inclusions, each once, in the order of the loads.
std::vector<Moved> inclusions_of(const std::vector<results::Load>& loads) {
  std::vector<Moved> all;
  std::map<std::string_view, std::size_t> places;
  for (const results::Load& load : loads) {
    for (const results::Inclusion& inclusion : load.inclusions) {
      const auto [place, is_new] = places.try_emplace(inclusion.name, all.size());
      if (is_new) all.push_back({inclusion.name});
      all[place->second].tilted |= inclusion.tilted();
    }
  }
  return all;
}

bool any_tilts(const std::vector<Moved>& inclusions) {
  return std::ranges::any_of(inclusions, &Moved::tilted);
}

using Member = double results::Inclusion::*;

// A number of an inclusion and, where it may have them, its bounds.
struct Column {
  const char* name;
  const char* dimension;  // as results::Units has it
  Member value;
  Member lower = nullptr, upper = nullptr;

  std::string of(const results::Inclusion& inclusion) const {
    if (lower == nullptr || !std::isfinite(inclusion.*lower)) return number(inclusion.*value);
    return results::interval(inclusion.*lower, inclusion.*upper);
  }
};

// What is told of an inclusion: of one that never tilts, A alone.
std::span<const Column> told_of(const Moved& inclusion) {
  using results::Inclusion;
  static constexpr std::array<Column, 5> columns{
      {{"A", "L", &Inclusion::displacement, &Inclusion::displacement_lower,
        &Inclusion::displacement_upper},
       {"Bx", "", &Inclusion::slope_x, &Inclusion::slope_x_lower, &Inclusion::slope_x_upper},
       {"By", "", &Inclusion::slope_y, &Inclusion::slope_y_lower, &Inclusion::slope_y_upper},
       {"Mx", "F L", &Inclusion::moment_x},
       {"My", "F L", &Inclusion::moment_y}}};
  return std::span(columns).first(inclusion.tilted ? columns.size() : 1);
}

// Above a column of the table: without a dimension the second row is empty there.
struct Head {
  std::string name;
  std::optional<std::string> dimension{};
};

// What the rows of the table tell of inclusions: each, or of many how far they move.
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
      for (const Column& column : told_of(inclusion)) {
        head.push_back({column.name, column.dimension});
        if (_inclusions.size() > 1) head.back().name += " " + sanitise(inclusion.name);
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
      const auto found =
          std::ranges::find(load.inclusions, inclusion.name, &results::Inclusion::name);
      const bool told = has_answer(load) && found != load.inclusions.end();
      for (const Column& column : told_of(inclusion)) row.push_back(told ? column.of(*found) : "-");
    }
  }

  // Below the table.
  std::string hint() const {
    if (each()) return "";
    return "all " + std::to_string(_inclusions.size()) +
           " inclusions: anticrack show RESULT --inclusions, or --csv FILE\n";
  }

  static constexpr const char* of = "of";  // heads a column of names

 private:
  void add_extremes(const results::Load& load, std::vector<std::string>& row) const {
    if (!has_answer(load) || load.inclusions.empty()) {
      row.insert(row.end(), {"-", "-", "", "-", ""});
      if (_tilt) row.insert(row.end(), {"-", ""});
      return;
    }
    constexpr std::size_t widest_name = 24;
    const auto add_one = [&row](const results::Inclusion& inclusion, std::string value) {
      row.insert(row.end(), {std::move(value), fit(sanitise(inclusion.name), widest_name)});
    };
    const Column* const moved = told_of({}).data();
    row.push_back(std::to_string(load.inclusions.size()));
    const auto [least, greatest] =
        std::ranges::minmax_element(load.inclusions, {}, &results::Inclusion::displacement);
    add_one(*least, moved->of(*least));
    add_one(*greatest, moved->of(*greatest));
    if (!_tilt) return;
    const auto slope = [](const results::Inclusion& inclusion) {
      return std::hypot(inclusion.slope_x, inclusion.slope_y);
    };
    const auto steepest = std::ranges::max_element(load.inclusions, {}, slope);
    add_one(*steepest, number(slope(*steepest)));
  }

  std::vector<Moved> _inclusions;
  bool _tilt;
};

bool is_bounded(const results::Load& load) {
  return has_answer(load) && std::isfinite(load.error_bound);
}

std::vector<std::string> row_of(const results::Load& load, const Told& inclusions, bool by_uzawa,
                                bool bounded) {
  const bool answered = has_answer(load);
  const auto when_answered = [answered](double value, int digits = 6, bool exponent = false) {
    return answered ? number(value, digits, exponent) : "-";
  };
  std::vector<std::string> row{
      sanitise(load.name), std::string(word(load.status)), std::to_string(load.iterations),
      when_answered(by_uzawa ? load.criterion : load.kkt_relative.largest(), 2, true)};
  inclusions.add(load, row);
  row.push_back(answered && std::isfinite(load.energy_lower)
                    ? results::interval(load.energy_lower, load.energy_upper)
                    : when_answered(load.energy));
  if (bounded)
    row.push_back(
        when_answered(100 * load.error_bound_relative, load.error_bound_relative < 1 ? 2 : 3));
  row.push_back(answered ? contact_text(load.contact_length) : "-");
  if (by_uzawa) {
    row.push_back(when_answered(load.theta, 4));
    row.push_back(when_answered(load.theta_star, 4));
  }
  row.push_back(seconds(load.solve_seconds));
  return row;
}

// Lines for people below the table.
std::vector<std::string> remarks_on(const results::Load& load) {
  std::vector<std::string> remarks;
  remarks.reserve(4 + load.warnings.size());
  if (const std::string& cause = load.error.empty() ? load.reason : load.error; !cause.empty())
    remarks.push_back(cause);
  if (load.weakly_active > 0) {
    remarks.push_back(std::to_string(load.weakly_active) +
                      (load.weakly_active == 1 ? " node just touches" : " nodes just touch") +
                      ": neither jump nor pressure");
  }
  for (const std::string& warning : load.warnings) remarks.push_back("warning: " + warning);
  if (!load.no_bracket.empty()) remarks.push_back("no bounds of the error: " + load.no_bracket);
  constexpr double small_error = 0.01;
  const bool in_stages = load.stages.size() > 0;  // the accuracy was chosen
  const double error = load.error_bound_relative;
  if (is_bounded(load) && load.error_bound > 0 && !std::isfinite(error) && !in_stages)
    remarks.push_back(
        "u is 0 on this mesh, but need not be on the membrane; take a smaller mesh.size");
  if (is_bounded(load) && std::isfinite(error) && error > small_error && !in_stages)
    remarks.push_back("u is within " + per_cent(error) +
                      " of the membrane's in the energy norm; for less write "
                      "[accuracy] energy = 1e-3, or smaller");
  return remarks;
}

Json stages_json(const results::Stages& stages) {
  Json json = Json::array();
  for (std::size_t i = 0; i < stages.size(); ++i) {
    json.push_back({{"triangles", stages.triangles[i]},
                    {"energy", stages.energy[i]},
                    {"energy_lower", stages.energy_lower[i]},
                    {"energy_upper", stages.energy_upper[i]},
                    {"error_bound_relative", stages.error_bound_relative[i]},
                    {"displacement_error", stages.displacement_error[i]},
                    {"seconds", stages.seconds[i]}});
  }
  return json;
}

Json contact_json(const results::Load& load, const std::vector<results::Interface>& interfaces) {
  Json json = Json::array();
  for (const results::ContactInterval& interval : load.contact_intervals) {
    json.push_back({{"interface", interfaces.at(interval.interface).name},
                    {"begin", interval.begin},
                    {"end", interval.end}});
  }
  return json;
}

}  // namespace

std::string answers_table(const std::vector<results::Load>& loads, const results::Units& units) {
  const Told inclusions(inclusions_of(loads));
  const bool by_uzawa = std::any_of(loads.begin(), loads.end(), [](const results::Load& load) {
    return std::isfinite(load.theta);
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
    rows[1].push_back(column.dimension ? sanitise(units.of(*column.dimension)) : "");
  }
  std::string remarks;
  for (const results::Load& load : loads) {
    rows.push_back(row_of(load, inclusions, by_uzawa, bounded));
    for (const std::string& remark : remarks_on(load))
      remarks += sanitise(load.name) + ": " + sanitise(remark) + "\n";
  }
  return table(rows, left) + inclusions.hint() + remarks;
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
  for (const Column& column : columns) {
    rows[0].emplace_back(column.name);
    rows[1].push_back(sanitise(result.units.of(column.dimension)));
  }
  rows[0].insert(rows[0].end(), {"resultant", "contact length"});
  rows[1].insert(rows[1].end(), {sanitise(result.units.of("F")), sanitise(result.units.of("L"))});
  for (const results::Load& load : result.loads) {
    if (!has_answer(load)) continue;
    for (const results::Inclusion& inclusion : load.inclusions) {
      auto& row = rows.emplace_back(std::vector{sanitise(load.name), sanitise(inclusion.name)});
      for (const Column& column : columns) row.push_back(column.of(inclusion));
      row.insert(row.end(), {number(inclusion.resultant), contact_text(inclusion.contact_length)});
    }
  }
  return rows.size() == 2 ? "no inclusions\n" : table(rows, {1});
}

std::string answers_csv(const results::Result& result) {
  if (result.sweep) return sweep_csv(*result.sweep);
  std::string text = "load,inclusion";
  arrays::for_each(
      [&](const auto& column) {
        if (column.name != "name") text.append(",").append(column.name);
      },
      results::tables::inclusions);
  text += '\n';
  for (const results::Load& load : result.loads) {
    if (!has_answer(load)) continue;
    for (const results::Inclusion& inclusion : load.inclusions) {
      text += csv_field(load.name) + "," + csv_field(inclusion.name);
      arrays::for_each(
          [&](const auto& column) {
            const auto& value = std::invoke(column.member, inclusion);
            if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(value)>>)
              text += "," + exact(value);
          },
          results::tables::inclusions);
      text += '\n';
    }
  }
  return text;
}

std::string answers_json(const results::Result& result, const std::filesystem::path& file) {
  Json json{{"title", result.title},
            {"file", file.string()},
            {"job", result.job_name},
            {"mesh", result.mesh_name},
            {"units", {{"length", result.units.length}, {"force", result.units.force}}},
            {"triangle_count", result.mesh.triangle_count()},
            {"node_count", result.mesh.node_count()},
            {"mesh_seconds", result.timings.mesh_seconds},
            {"factorize_seconds", result.timings.factorize_seconds},
            {"solve_seconds", result.timings.solve_seconds},
            {"total_seconds", result.timings.total_seconds},
            {"not_reached", result.not_reached},
            {"notes", results::notes_on(result)}};
  if (result.sweep) json["sweep"] = sweep_json(*result.sweep);
  Json& answers = json["answers"] = Json::array();
  for (const results::Load& load : result.loads) {
    Json inclusions = Json::array();
    for (const results::Inclusion& inclusion : load.inclusions) {
      inclusions.push_back({{"name", inclusion.name},
                            {"A", inclusion.displacement},
                            {"A_lower", inclusion.displacement_lower},
                            {"A_upper", inclusion.displacement_upper},
                            {"A_estimated_error", inclusion.displacement_estimated_error},
                            {"Bx", inclusion.slope_x},
                            {"By", inclusion.slope_y},
                            {"resultant", inclusion.resultant},
                            {"Mx", inclusion.moment_x},
                            {"My", inclusion.moment_y},
                            {"contact_length", inclusion.contact_length}});
    }
    answers.push_back(
        {{"name", load.name},
         {"status", results::name(load.status)},
         {"reason", load.reason},
         {"error", load.error},
         {"method", load.method},
         {"iterations", load.iterations},
         {"criterion", load.criterion},
         {"worst_kkt", has_answer(load) ? load.kkt_relative.largest() : results::unknown},
         {"theta", load.theta},
         {"theta_star", load.theta_star},
         {"energy", load.energy},
         {"energy_lower", load.energy_lower},
         {"energy_upper", load.energy_upper},
         {"error_bound", load.error_bound},
         {"error_bound_relative", load.error_bound_relative},
         {"no_bracket", load.no_bracket},
         {"contact_length", load.contact_length},
         {"contact_intervals", contact_json(load, result.interfaces)},
         {"weakly_active", load.weakly_active},
         {"solve_seconds", load.solve_seconds},
         {"inclusions", std::move(inclusions)},
         {"stages", stages_json(load.stages)},
         {"warnings", load.warnings}});
  }
  return to_text(json);
}

}  // namespace anticrack::cli
