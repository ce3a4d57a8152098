// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

using Keys = std::vector<std::string>;

const Keys uzawa_keys{"theta", "epsilon", "p", "max_iterations", "mass", "kkt_tolerance"};
const Keys active_set_keys{"tolerance", "max_steps"};

Keys all_keys() {
  Keys keys{"method"};
  keys.insert(keys.end(), uzawa_keys.begin(), uzawa_keys.end());
  keys.insert(keys.end(), active_set_keys.begin(), active_set_keys.end());
  return keys;
}

bool is_override(const Spot& spot) { return spot.source.starts_with("--set "); }

// The keys of one method do not go with another. The cure is where the wrong one of the two was
// written: in the case, or by --set.
void refuse_other_method(const Section& section, const Keys& keys, const std::string& method,
                         const std::string& other) {
  std::string found;
  const std::string* first = nullptr;
  bool several = false;
  for (const std::string& key : keys) {
    if (!section.find(key)) continue;
    several = first != nullptr;
    found += (several ? ", " : "") + key;
    if (!several) first = &key;
  }
  if (first == nullptr) return;
  const Spot spot = section.spot_of(*first);
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

void read_step(const Section& section, v1::Uzawa& uzawa) {
  const toml::node* node = section.find("theta");
  if (!node) return;
  if (node->value_exact<std::string>() == "auto") {
    uzawa.set_theta_auto(true);
  } else {
    uzawa.set_theta(
        number_of(*node, section.path_of("theta"), "write a number above 0, or \"auto\""));
  }
}

void read_uzawa(const Section& section, v1::Uzawa& uzawa, Spots& spots) {
  refuse_other_method(section, active_set_keys, "uzawa", "active-set");
  read_step(section, uzawa);
  if (const auto epsilon = section.number("epsilon")) uzawa.set_epsilon(*epsilon);
  if (const auto p = section.number("p")) uzawa.set_p(*p);
  if (const auto limit = section.count("max_iterations")) uzawa.set_max_iterations(*limit);
  if (const auto mass = section.choice("mass", {"lumped", "consistent"}))
    uzawa.set_mass(*mass == 0 ? v1::MASS_LUMPED : v1::MASS_CONSISTENT);
  if (const auto tolerance = section.number("kkt_tolerance")) uzawa.set_kkt_tolerance(*tolerance);
  note(section, "solver.uzawa", spots);
  spots["solver.uzawa"] = section.spot_of("method");
  if (uzawa.theta_auto()) spots["solver.uzawa.theta_auto"] = section.spot_of("theta");
}

void read_active_set(const Section& section, v1::ActiveSet& active_set, Spots& spots) {
  refuse_other_method(section, uzawa_keys, "active-set", "uzawa");
  if (const auto tolerance = section.number("tolerance")) active_set.set_tolerance(*tolerance);
  if (const auto limit = section.count("max_steps")) active_set.set_max_steps(*limit);
  note(section, "solver.active_set", spots);
  spots["solver.active_set"] = section.spot_of("method");
}

}  // namespace

v1::Solver read_solver(const Section& root, Spots& spots) {
  v1::Solver solver;
  const auto section = root.section("solver", all_keys());
  if (!section) {
    solver.mutable_active_set();
    return solver;
  }
  note(*section, "solver", spots);
  if (section->choice("method", {"active-set", "uzawa"}).value_or(0) == 0)
    read_active_set(*section, *solver.mutable_active_set(), spots);
  else
    read_uzawa(*section, *solver.mutable_uzawa(), spots);
  return solver;
}

}  // namespace anticrack::casefile
