// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "estimate/bracket.hpp"
#include "estimate/load_balance.hpp"
#include "mesh/at.hpp"
#include "operators/displacement_bounds.hpp"

namespace anticrack::operators {
namespace {

std::string obstacle_of(const LoadOnTraces& load, const estimate::CutMesh& cut,
                        const contact::Answer& answer) {
  if (!cut.obstacle.empty()) return cut.obstacle;
  if (!load.parts.obstacle.empty()) return load.parts.obstacle;
  if (!bounded(answer)) return "the discrete problem is not solved to 1e-10; see its KKT residuals";
  return "";
}

}  // namespace

std::vector<double> MeshOperator::estimate(const PreparedLoad& load, contact::Answer& answer,
                                           const std::stop_token& stop) const {
  require_prepared(load, true);
  const LoadOnTraces& condensed = load._data->condensed;
  const std::vector<ddm::Subdomain>& subdomains = _parts->decomposition.subdomains;
  const estimate::CutMesh& cut =
      _parts->cut.get([this] { return estimate::cut_mesh(*_parts->mesh, _parts->decomposition); });
  answer.no_bracket = obstacle_of(condensed, cut, answer);
  if (!answer.no_bracket.empty()) return {};
  if (stop.stop_requested())
    throw errors::Error(errors::Reason::cancelled, "stopped before the error was estimated");

  const bool recovered = answer.fields.empty();
  if (recovered) {
    const PreparedLoad* const one[] = {&load};
    contact::Answer* const its[] = {&answer};
    recover_fields(one, its);
  }
  const std::vector<double> u = of_copies(answer.fields);
  if (recovered) answer.fields.clear();

  std::vector<fem::ForceParts> force = condensed.parts.integrated;
  for (std::size_t s = 0; s < force.size(); ++s) {
    if (auto linear =
            fem::linear_parts(subdomains[s].part, condensed.parts.force, subdomains[s].name,
                              {subdomains[s].node, subdomains[s].triangle, stop}))
      force[s] = std::move(*linear);
  }
  std::vector<estimate::Lift> lifts;
  if (const std::string& given = condensed.parts.boundary_value; !given.empty())
    lifts = estimate::lifts(cut,
                            fem::values_at(estimate::lift_points(cut), given, "boundary_value"), u);
  if (!std::ranges::all_of(lifts, &estimate::Lift::smooth)) {
    answer.no_bracket =
        "boundary_value jumps along an edge, or is too sharp for the mesh: make it continuous, or "
        "the mesh finer";
    return {};
  }
  const estimate::LoadBalance balance =
      estimate::load_balance(cut, force, condensed.parts.traction);
  const estimate::EquilibratedFlux flux(cut, {u, balance.force, balance.traction});
  estimate::Bracket bracket = estimate::bracket(cut, flux, balance, lifts, u, answer.energy);
  answer.energy_lower = bracket.lower;
  answer.energy_upper = bracket.upper;
  answer.error_bound = bracket.error;
  answer.error_bound_relative = bracket.error_relative;
  bound_displacements(*_parts, condensed, {cut, flux, balance, lifts, u}, answer, stop);
  std::vector<double> indicator(bracket.indicator.size());
  for (std::size_t t = 0; t < indicator.size(); ++t)
    indicator[at(cut.triangle[t])] = bracket.indicator[t];
  return indicator;
}

}  // namespace anticrack::operators
