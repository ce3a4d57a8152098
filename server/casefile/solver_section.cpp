// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

bool is_override(const Spot& spot) { return spot.source.starts_with("--set "); }

// Refuses keys of another method. The cure depends on where the method and the key were written: in
// the case, or by --set.
void refuse_other_method(const Section& section, const std::string& method,
                         const std::string& other) {
  std::string found, first;
  for (const Key* key : section.keys().known()) {
    if (key->only != other || !section.find(key->name)) continue;
    if (first.empty()) first = key->name;
    found += (found.empty() ? "" : ", ") + std::string(key->name);
  }
  if (first.empty()) return;
  const bool several = found != first;
  const Spot spot = section.spot_of(first);
  const auto whole_section = [](const std::string& name) {
    return "--set 'solver={method=\"" + name + "\"}'";
  };
  const std::string remove = several ? "remove them" : "remove it";
  std::string problem = several ? found + " belong" : "belongs";
  problem += " to method \"" + other + "\"; ";
  if (is_override(section.spot_of("method"))) {
    problem += "write " + whole_section(method) + ", which replaces all of [solver]";
    problem += is_override(spot) ? "" : ", or " + remove + " from the case";
  } else if (is_override(spot)) {
    problem += remove + ", or put " + whole_section(other) + " before it";
  } else {
    problem += remove + ", or write method = \"" + other + "\"";
  }
  throw Error(spot, problem);
}

void read_step(const Section& section, v1::Uzawa& uzawa, Spots& spots) {
  const toml::node* node = section.find("theta");
  if (!node) return;
  if (node->value_exact<std::string>() == "auto") {
    uzawa.set_theta_auto(true);
    spots["solver.uzawa.theta_auto"] = section.spot_of("theta");
  } else {
    uzawa.set_theta(
        number_of(*node, section.path_of("theta"), "write a number above 0, or \"auto\""));
  }
}

}  // namespace

v1::Solver read_solver(const Section& root, Spots& spots) {
  v1::Solver solver;
  const auto section = root.section("solver");
  const bool uzawa = section && section->choice("method", {"active-set", "uzawa"}) == 1U;
  if (uzawa)
    solver.mutable_uzawa();
  else
    solver.mutable_active_set();
  if (!section) return solver;
  refuse_other_method(*section, uzawa ? "uzawa" : "active-set", uzawa ? "active-set" : "uzawa");
  fill(*section, solver, "solver", spots);
  if (uzawa) read_step(*section, *solver.mutable_uzawa(), spots);
  spots[uzawa ? "solver.uzawa" : "solver.active_set"] = section->spot_of("method");
  return solver;
}

}  // namespace anticrack::casefile
