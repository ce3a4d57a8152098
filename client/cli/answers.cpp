// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/answers.hpp"

#include <algorithm>
#include <cmath>
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

// Names of all inclusions, each once.
std::vector<std::string> inclusions_of(const std::vector<results::Load>& loads) {
  std::vector<std::string> names;
  for (const results::Load& load : loads) {
    for (const results::Inclusion& inclusion : load.inclusions)
      if (std::find(names.begin(), names.end(), inclusion.name) == names.end())
        names.push_back(inclusion.name);
  }
  return names;
}

std::string displacement_of(const results::Load& load, const std::string& name) {
  const auto found = std::find_if(load.inclusions.begin(), load.inclusions.end(),
                                  [&](const auto& inclusion) { return inclusion.name == name; });
  return found == load.inclusions.end() ? "-" : number(found->displacement);
}

std::vector<std::string> row_of(const results::Load& load,
                                const std::vector<std::string>& inclusions, bool by_uzawa) {
  const bool answered = has_answer(load);
  const auto when_answered = [answered](double value, int digits = 6, bool exponent = false) {
    return answered ? number(value, digits, exponent) : "-";
  };
  std::vector<std::string> row{
      sanitise(load.name), std::string(word(load.status)), std::to_string(load.iterations),
      when_answered(by_uzawa ? load.criterion : load.kkt_relative.largest(), 2, true)};
  for (const std::string& name : inclusions)
    row.push_back(answered ? displacement_of(load, name) : "-");
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
  const std::vector<std::string> inclusions = inclusions_of(loads);
  const bool by_uzawa = std::any_of(loads.begin(), loads.end(), [](const results::Load& load) {
    return std::isfinite(load.theta);
  });
  std::vector<std::string> head{"load", "status", "iterations", by_uzawa ? "criterion" : "KKT"};
  for (const std::string& name : inclusions)
    head.push_back(inclusions.size() == 1 ? "A" : "A " + sanitise(name));
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
                            {"resultant", inclusion.resultant},
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
