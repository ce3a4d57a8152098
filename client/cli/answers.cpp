// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/answers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "cli/json.hpp"
#include "cli/progress.hpp"
#include "cli/sweep_text.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

bool has_answer(const results::Load& load) {
  return load.status == results::Status::converged || load.status == results::Status::not_converged;
}

struct Moved {
  std::string name;
  bool tilted = false;  // in one of the loads at least
};

// All inclusions, each once.
std::vector<Moved> inclusions_of(const std::vector<results::Load>& loads) {
  std::vector<Moved> all;
  for (const results::Load& load : loads) {
    for (const results::Inclusion& inclusion : load.inclusions) {
      auto place = std::ranges::find(all, inclusion.name, &Moved::name);
      if (place == all.end()) place = all.insert(all.end(), {inclusion.name});
      place->tilted |= inclusion.tilted();
    }
  }
  return all;
}

using Column = std::pair<const char*, double results::Inclusion::*>;

// What is told of an inclusion: of one that never tilts, A alone.
std::span<const Column> told_of(const Moved& inclusion) {
  using results::Inclusion;
  static constexpr std::array<Column, 5> columns{{{"A", &Inclusion::displacement},
                                                  {"Bx", &Inclusion::slope_x},
                                                  {"By", &Inclusion::slope_y},
                                                  {"Mx", &Inclusion::moment_x},
                                                  {"My", &Inclusion::moment_y}}};
  return std::span(columns).first(inclusion.tilted ? columns.size() : 1);
}

void add_inclusion(const results::Load& load, const Moved& inclusion,
                   std::vector<std::string>& row) {
  const auto found = std::ranges::find(load.inclusions, inclusion.name, &results::Inclusion::name);
  const bool told = has_answer(load) && found != load.inclusions.end();
  for (const auto& [name, member] : told_of(inclusion))
    row.push_back(told ? number((*found).*member) : "-");
}

std::vector<std::string> row_of(const results::Load& load, const std::vector<Moved>& inclusions,
                                bool by_uzawa) {
  const bool answered = has_answer(load);
  const auto when_answered = [answered](double value, int digits = 6, bool exponent = false) {
    return answered ? number(value, digits, exponent) : "-";
  };
  std::vector<std::string> row{
      sanitise(load.name), std::string(word(load.status)), std::to_string(load.iterations),
      when_answered(by_uzawa ? load.criterion : load.kkt_relative.largest(), 2, true)};
  for (const Moved& inclusion : inclusions) add_inclusion(load, inclusion, row);
  row.push_back(when_answered(load.energy));
  row.push_back(when_answered(load.contact_length));
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
  remarks.reserve(2 + load.warnings.size());
  if (const std::string& cause = load.error.empty() ? load.reason : load.error; !cause.empty())
    remarks.push_back(cause);
  if (load.weakly_active > 0) {
    remarks.push_back(std::to_string(load.weakly_active) +
                      (load.weakly_active == 1 ? " node just touches" : " nodes just touch") +
                      ": neither jump nor pressure");
  }
  for (const std::string& warning : load.warnings) remarks.push_back("warning: " + warning);
  return remarks;
}

}  // namespace

std::string answers_table(const std::vector<results::Load>& loads) {
  const std::vector<Moved> inclusions = inclusions_of(loads);
  const bool by_uzawa = std::any_of(loads.begin(), loads.end(), [](const results::Load& load) {
    return std::isfinite(load.theta);
  });
  std::vector<std::string> head{"load", "status", "iterations", by_uzawa ? "criterion" : "KKT"};
  for (const Moved& inclusion : inclusions) {
    for (const auto& [name, member] : told_of(inclusion))
      head.push_back(inclusions.size() == 1 ? name : name + (" " + sanitise(inclusion.name)));
  }
  head.insert(head.end(), {"energy", "contact length"});
  if (by_uzawa) head.insert(head.end(), {"theta", "theta*"});
  head.emplace_back("wall time");
  std::vector<std::string> units(head.size(), "-");
  units[0] = units[1] = "";
  units.back() = "s";
  std::vector<std::vector<std::string>> rows{head, units};
  std::string remarks;
  for (const results::Load& load : loads) {
    rows.push_back(row_of(load, inclusions, by_uzawa));
    for (const std::string& remark : remarks_on(load))
      remarks += sanitise(load.name) + ": " + sanitise(remark) + "\n";
  }
  return table(rows, {1}) + remarks;
}

std::string answers_table(const results::Result& result) {
  return result.sweep ? sweep_table(*result.sweep) : answers_table(result.loads);
}

std::string answers_json(const results::Result& result, const std::filesystem::path& file) {
  Json json{{"title", result.title},
            {"file", file.string()},
            {"job", result.job_name},
            {"mesh", result.mesh_name},
            {"mesh_seconds", result.timings.mesh_seconds},
            {"factorize_seconds", result.timings.factorize_seconds},
            {"solve_seconds", result.timings.solve_seconds},
            {"total_seconds", result.timings.total_seconds}};
  if (result.sweep) json["sweep"] = sweep_json(*result.sweep);
  Json& answers = json["answers"] = Json::array();
  for (const results::Load& load : result.loads) {
    Json inclusions = Json::array();
    for (const results::Inclusion& inclusion : load.inclusions) {
      inclusions.push_back({{"name", inclusion.name},
                            {"A", inclusion.displacement},
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
         {"contact_length", load.contact_length},
         {"weakly_active", load.weakly_active},
         {"solve_seconds", load.solve_seconds},
         {"inclusions", std::move(inclusions)},
         {"warnings", load.warnings}});
  }
  return to_text(json);
}

}  // namespace anticrack::cli
