// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "estimate/bracket.hpp"
#include "estimate/chord_gap.hpp"
#include "operators/displacement_bounds.hpp"
#include "operators/load_bounds.hpp"
#include "operators/resultant_bounds.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

constexpr const char* bounding = "computing bounds";

std::string obstacle_of(const LoadOnTraces& load, const estimate::CutMesh& cut,
                        const contact::Answer& answer) {
  if (!cut.obstacle.empty()) return cut.obstacle;
  if (!load.parts.obstacle.empty()) return load.parts.obstacle;
  if (!bounded(answer, cut))
    return "contact alone holds a part of the membrane, and " + contact::residuals_of(answer) +
           ", above 1e-10: hold that part by glue or a prescribed value";
  return "";
}

/// Energies are squares, which vanish or overflow if u is very small or very large.
std::string obstacle_of(std::span<const double> u, double tension) {
  const double largest = estimate::largest_of(u);
  if (estimate::in_range(tension, largest)) return "";
  return fmt::format(
      "the largest |u| is {:g}, and its square is beyond the range of numbers: scale the load {}",
      largest, tension * largest * largest < 1 ? "up" : "down");
}

/// The data from which the bounds of an answer are made.
struct Material {
  MeshOperator::Estimate& of;
  const LoadOnTraces& load;
  std::vector<double> u;
  std::vector<estimate::Lift> lifts;
  estimate::LoadBalance balance;
  std::vector<double> across_chords;
  double parts_energy = 0;
};

/// The fluxes of sigma through the sides of the mesh's triangles.
std::vector<double> through_sides(const MeshOperator::Parts& parts, const estimate::CutMesh& cut,
                                  const estimate::EquilibratedFlux& flux, const Material& of) {
  std::vector<double> result(3 * cut.triangle_count());
  const std::vector<ddm::Subdomain>& subdomains = parts.decomposition.subdomains;
  for (std::size_t s = 0; s < subdomains.size(); ++s)
    for (std::size_t t = at(cut.first_triangle[s]); t < at(cut.first_triangle[s + 1]); ++t) {
      const double* f = of.balance.force.empty() ? nullptr : &of.balance.force[3 * t];
      const double mean = f == nullptr ? 0 : (f[0] + f[1] + f[2]) / 3;
      const estimate::Vector off = flux.mean_difference(t);
      const std::int32_t* corner = &parts.mesh->triangles[3 * at(cut.triangle[t])];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t side = 3 * t + i;
        const std::int32_t node = subdomains[s].node[at(cut.copy[side] - cut.first_copy[s])];
        const auto place = static_cast<std::size_t>(std::find(corner, corner + 2, node) - corner);
        const estimate::Vector normal = flux.normal_of(side);
        result[3 * at(cut.triangle[t]) + place] =
            flux.flux_through(side, of.u) + off[0] * normal[0] + off[1] * normal[1] - mean;
      }
    }
  return result;
}

void find_bounds(const MeshOperator::Parts& parts, const estimate::CutMesh& cut,
                 std::span<const Material> materials) {
  std::vector<estimate::Balance> balances;
  for (const Material& one : materials)
    balances.push_back({one.u, one.balance.force, one.balance.traction});
  const std::vector<estimate::EquilibratedFlux> fluxes =
      estimate::EquilibratedFlux::of_all(cut, balances);
  const estimate::StiffPart* const stiff =
      parts.mesh->inclusions.empty() ? nullptr : parts.stiff_part();
  std::vector<estimate::Primal> primals;
  std::vector<estimate::Bracket> brackets;
  std::vector<Bounded> bounded;
  primals.reserve(materials.size());
  brackets.reserve(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto& [of, load, u, lifts, balance, across, parts_energy] = materials[i];
    contact::Answer& answer = *of.answer;
    if (cancels(parts_energy, answer.energy_mesh, fluxes[i].norm_squared())) {
      answer.no_bracket =
          "the loads that are combined cancel, and rounding is not small beside what they leave: "
          "give their sum as a load of its own";
      continue;
    }
    const estimate::Lack lack = lack_of(cut, fluxes[i], balance, load);
    const estimate::Bracket& bracket = brackets.emplace_back(
        estimate::bracket(cut, fluxes[i], balance, lifts, u, answer.energy_mesh, lack.flux));
    answer.energy_lower = bracket.lower;
    answer.energy_upper = bracket.upper;
    answer.error_bound = bracket.error;
    answer.error_bound_relative = bracket.error_relative;
    if (!cut.chords.empty()) {
      answer.energy_geometry_error =
          estimate::chord_gap(cut, parts.decomposition.subdomains, balance, {u, across});
    }
    if (of.keep_flux) of.balanced_flux = through_sides(parts, cut, fluxes[i], materials[i]);
    of.indicator.resize(bracket.indicator.size());
    for (std::size_t t = 0; t < bracket.indicator.size(); ++t)
      of.indicator[at(cut.triangle[t])] = bracket.indicator[t];
    if (of.of_energy) continue;
    primals.push_back({cut, fluxes[i], balance, lifts, u, lack, stiff});
    bounded.push_back({load, primals.back(), bracket, answer, of.stop, of.closely, of.of_largest,
                       &of.indicator, across});
  }
  bound_displacements(parts, bounded);
  bound_resultants(parts, bounded);
  for (const Bounded& one : bounded) contact::take_middles(one.answer);
}

}  // namespace

std::vector<double> MeshOperator::estimate(const PreparedLoad& load, contact::Answer& answer,
                                           const std::stop_token& stop) const {
  Estimate one{&load, &answer, stop, true};
  estimate({&one, 1});
  if (one.failure) std::rethrow_exception(one.failure);
  return std::move(one.indicator);
}

void MeshOperator::make_ready_for_bounds() const {
  _parts->cut_mesh();
  _parts->boundary_forces();
}

std::size_t MeshOperator::estimated_together() const noexcept {
  constexpr std::size_t most_together = 8;         // more are not faster
  constexpr std::size_t most_triangles = 600'000;  // of all answers together: 270 MB
  return std::clamp(most_triangles / _parts->mesh->triangle_count(), std::size_t{1}, most_together);
}

void MeshOperator::estimate(std::span<Estimate> all) const {
  const std::size_t together = estimated_together();
  for (; all.size() > together; all = all.subspan(together)) estimate(all.first(together));
  if (all.empty()) return;
  const stop::Scope scope([all](const stop::Look&) {
    return std::ranges::all_of(all, [](const Estimate& one) { return one.stop.stop_requested(); });
  });
  const auto kept = static_cast<std::size_t>(std::ranges::count(all, true, &Estimate::keep_flux));
  const Working counted(_parts->at_work,
                        _parts->mesh->triangle_count() *
                            (all.size() * bytes_per_triangle_and_load + kept * 3 * sizeof(double)));
  const estimate::CutMesh& cut = _parts->cut_mesh();
  std::vector<Material> materials;
  for (Estimate& one : all) {
    const stop::Scope own(one.stop);
    try {
      stop::look(bounding);
      require_prepared(*one.load, true);
      const PreparedLoad::Data& data = *one.load->_data;
      const LoadOnTraces& load = data.condensed;
      contact::Answer& answer = *one.answer;
      answer.no_bracket = obstacle_of(load, cut, answer);
      if (!answer.no_bracket.empty()) continue;
      const bool recovered = answer.fields.empty();
      if (recovered) recover_fields({&one.load, 1}, {&one.answer, 1});
      Material material{one, load, of_copies(answer.fields), {}, {}, {}};
      if (recovered) answer.fields.clear();
      if (material.u.size() != cut.at.size()) {  // its solution was stopped
        throw errors::Error(errors::Reason::cancelled, "stopped while {}", bounding);
      }
      answer.no_bracket = obstacle_of(material.u, cut.shapes.largest_tension);
      if (!answer.no_bracket.empty()) continue;
      BalancedLoad of_load = data.balanced
                                 ? *data.balanced
                                 : balanced(load.parts, _parts->decomposition.subdomains, cut);
      answer.no_bracket = of_load.obstacle;
      if (!answer.no_bracket.empty()) continue;
      if (!of_load.boundary.empty())
        material.lifts = estimate::lifts(cut, of_load.boundary, material.u);
      material.balance = std::move(of_load.balance);
      material.across_chords = std::move(of_load.across_chords);
      material.parts_energy = data.parts_energy;
      materials.push_back(std::move(material));
    } catch (...) {
      one.failure = std::current_exception();
    }
  }
  if (materials.empty()) return;  // all were stopped, or none has bounds
  try {
    find_bounds(*_parts, cut, materials);
    for (const Material& one : materials) {
      if (one.of.stop.stop_requested())
        one.of.failure = std::make_exception_ptr(
            errors::Error(errors::Reason::cancelled, std::string("stopped while ") + bounding));
    }
  } catch (...) {
    for (const Material& one : materials) one.of.failure = std::current_exception();
  }
}

}  // namespace anticrack::operators
