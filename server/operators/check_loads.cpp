// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/check_loads.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <variant>

#include "errors/errors.hpp"
#include "words/nearest.hpp"

namespace anticrack::operators {
namespace {

using Motions = std::map<std::string, mesh::Motion>;

[[noreturn]] void refuse(const std::string& field, const std::string& problem) {
  throw errors::Error(errors::Reason::invalid_argument, problem).at(field);
}

template <class Known>
void require_known(const std::string& name, const std::string& what, const Known& known,
                   const std::string& field) {
  if (known.contains(name)) return;
  std::vector<std::string> names;
  for (const auto& [each, unused] : known) names.push_back(each);
  refuse(field, "there is no " + what + " \"" + name + "\"; " +
                    (names.empty() ? "name one by [[geometry." + what + "]]"
                                   : words::suggestion(name, names)));
}

void refuse_held(const fem::Load& load, const Motions& motions, const std::string& path) {
  for (const auto& [name, force] : load.inclusion_forces) {
    const auto motion = motions.find(name);
    if (motion == motions.end() || !motion->second.fixed) continue;
    refuse(path + ".inclusion_forces[" + name + "]",
           "the inclusion is held by its key fixed, so a force on it moves nothing; leave one of "
           "the two out");
  }
}

/// Whether all of the boundary is a Neumann boundary. Parts that make it one together are seen on
/// the mesh.
bool is_all_neumann(const mesh::Geometry& geometry) {
  const auto named = [&](const auto& one) {
    return std::ranges::find(geometry.neumann_sides, one.name) != geometry.neumann_sides.end();
  };
  const bool outer =
      std::ranges::any_of(geometry.neumann,
                          [](const mesh::Part& one) { return one.from == one.to; }) ||
      (!geometry.sides.empty() && std::ranges::all_of(geometry.sides, named));
  return outer && std::ranges::all_of(geometry.holes, named);
}

void check(const fem::Load& load, const mesh::Geometry& geometry, const Motions& motions,
           const std::map<std::string, int>& regions, const std::string& path) {
  if (acts(load.traction) && geometry.neumann.empty() && geometry.neumann_sides.empty()) {
    refuse(path + ".traction",
           "nothing has a traction, as no part of the boundary is in geometry.neumann; name its "
           "sides or holes there");
  }
  if (acts(load.boundary_value) && is_all_neumann(geometry))
    refuse(path + ".boundary_value", no_boundary_value);
  if (const auto* force = std::get_if<fem::PerRegion>(&load.force)) {
    // Subdomains without a region are called omega1, omega2, ...; only the mesh tells how many.
    for (const auto& [name, value] : force->values)
      if (!name.starts_with("omega"))
        require_known(name, "region", regions, path + ".force.per_region[" + name + "]");
  }
  for (const auto& [name, force] : load.inclusion_forces)
    require_known(name, "inclusion", motions, path + ".inclusion_forces[" + name + "]");
  for (const auto& [name, moment] : load.inclusion_moments) {
    const std::string field = path + ".inclusion_moments[" + name + "]";
    require_known(name, "inclusion", motions, field);
    if (motions.at(name).tilt) continue;
    refuse(field,
           "the inclusion does not tilt, so a moment on it does nothing; write tilt = true in its "
           "[[geometry.inclusion]], or leave the moment out");
  }
}

std::string path_of(std::size_t load) { return fmt::format("load_cases[{}]", load); }

}  // namespace

void check_loads(const std::vector<fem::Load>& loads, const mesh::Geometry& geometry) {
  Motions motions;
  std::map<std::string, int> regions;
  for (const mesh::InclusionSpec& inclusion : geometry.inclusions)
    motions.emplace(inclusion.name, inclusion.motion);
  for (const mesh::RegionSpec& region : geometry.regions) regions.emplace(region.name, 0);
  for (std::size_t i = 0; i < loads.size(); ++i)
    check(loads[i], geometry, motions, regions, path_of(i));
  check_loads(loads, motions);
}

void check_loads(const std::vector<fem::Load>& loads,
                 const std::map<std::string, mesh::Motion>& motions) {
  for (std::size_t i = 0; i < loads.size(); ++i) refuse_held(loads[i], motions, path_of(i));
}

}  // namespace anticrack::operators
