// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "contact/adjoint.hpp"
#include "contact/trace_state.hpp"
#include "estimate/bracket.hpp"
#include "estimate/interval.hpp"
#include "estimate/load_balance.hpp"
#include "mesh/at.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {
namespace {

/// Of bounds of the cone; most answers need two.
constexpr int most_tries = 4;

/// Above it u_h does not solve the discrete problem well enough.
constexpr double most_kkt = 1e-10;

std::string obstacle_of(const LoadOnTraces& load, const estimate::CutMesh& cut,
                        const contact::Answer& answer) {
  if (!cut.obstacle.empty()) return cut.obstacle;
  if (!load.parts.obstacle.empty()) return load.parts.obstacle;
  if (answer.status != contact::Status::converged ||
      !contact::within(answer.kkt_relative, most_kkt))
    return "the discrete problem is not solved to 1e-10; see its KKT residuals";
  return "";
}

using Displacement = std::optional<double>;

/// A displacement of an inclusion, and where its bounds go.
struct Aim {
  const ddm::Terms& goal;
  double value;
  Displacement &lower, &upper;
  Displacement* estimate;
};

class Intervals {
 public:
  Intervals(const MeshOperator::Parts& parts, const LoadOnTraces& load,
            const contact::Answer& answer, const estimate::Primal& primal)
      : _parts(parts),
        _primal(primal),
        _adjoint(*parts.skeleton, {load.subdomains, load.inclusion_forces}, answer) {}

  bool possible() const { return _adjoint.possible(); }

  /// The best of a few bounds of the cone, each wider than the one before.
  void find(const Aim& aim, double norm) const {
    const contact::Adjoint::Goal goal = _adjoint.aim(aim.goal);
    if (!(goal.compliance > 0)) {  // held
      aim.lower = aim.upper = aim.value;
      return;
    }
    const double unit = norm > 0 ? std::sqrt(goal.compliance) / norm : 1;
    double unloaded = 0;
    if (!_primal.load.oscillation.empty()) {
      const contact::Adjoint::Pair pair = _adjoint.clipped(goal, 0);
      unloaded = estimate::norm_of_flux(_primal.cut, fields({&pair.z, &pair.reacting})[1]);
    }
    estimate::Interval best;
    double c = 2 * unit;
    for (int tries = 0; tries < most_tries; ++tries) {
      const contact::Adjoint::Pair pair = _adjoint.clipped(goal, c);
      const auto [z, reacting] = fields({&pair.z, &pair.reacting});
      const estimate::Interval one =
          estimate::interval(_primal, {z, reacting, aim.value, pair.work, c}, unloaded);
      const bool better = one.width() < best.width();
      if (better) best.estimate = one.estimate;
      best.lower = std::max(best.lower, one.lower);
      best.upper = std::min(best.upper, one.upper);
      if (!better || !(one.short_of > 1)) break;
      c *= std::clamp(one.short_of, 1.5, 8.0);
    }
    aim.lower = best.lower;
    aim.upper = best.upper;
    if (aim.estimate != nullptr) *aim.estimate = best.estimate;
  }

 private:
  /// In the copies, without loads of their own.
  std::array<std::vector<double>, 2> fields(
      const std::array<const Eigen::VectorXd*, 2>& unknowns) const {
    std::array<std::vector<double>, 2> fields;
    std::array<std::vector<Eigen::VectorXd>, 2> traces;
    for (std::size_t f = 0; f < 2; ++f) traces[f] = _parts.skeleton->scatter(*unknowns[f]);
    for (std::size_t s = 0; s < _parts.operators.size(); ++s) {
      const ddm::Subdomain& subdomain = _parts.decomposition.subdomains[s];
      ddm::CondensedLoad none;
      none.z_interior.setZero(static_cast<Eigen::Index>(subdomain.interior));
      none.dirichlet.setZero(static_cast<Eigen::Index>(subdomain.dirichlet));
      const auto count = static_cast<Eigen::Index>(subdomain.node.size());
      std::array<Eigen::VectorXd, 2> values{Eigen::VectorXd(count), Eigen::VectorXd(count)};
      std::array<ddm::SubdomainOperator::Solved, 2> both{
          {{none, traces[0][s], values[0]}, {none, traces[1][s], values[1]}}};
      _parts.operators[s].recover(both);
      for (std::size_t f = 0; f < 2; ++f)
        fields[f].insert(fields[f].end(), values[f].begin(), values[f].end());
    }
    return fields;
  }

  const MeshOperator::Parts& _parts;
  const estimate::Primal& _primal;
  contact::Adjoint _adjoint;
};

/// Of each inclusion that moves.
void add_intervals(const MeshOperator::Parts& parts, const LoadOnTraces& load,
                   const estimate::Primal& primal, contact::Answer& answer) {
  constexpr std::size_t most_inclusions = 16;  // a few solves each
  if (!parts.skeleton || answer.inclusions.size() > most_inclusions) return;
  const Intervals intervals(parts, load, answer, primal);
  if (!intervals.possible()) return;
  const double norm = std::sqrt(primal.flux.norm_squared());
  for (std::size_t j = 0; j < answer.inclusions.size(); ++j) {
    const ddm::RigidMotion& motion = parts.decomposition.skeleton.motions[j];
    contact::InclusionAnswer& one = answer.inclusions[j];
    intervals.find({motion.displacement, one.displacement, one.displacement_lower,
                    one.displacement_upper, &one.displacement_estimated_error},
                   norm);
    if (!motion.slope_x.empty())
      intervals.find({motion.slope_x, one.slope_x, one.slope_x_lower, one.slope_x_upper, nullptr},
                     norm);
    if (!motion.slope_y.empty())
      intervals.find({motion.slope_y, one.slope_y, one.slope_y_lower, one.slope_y_upper, nullptr},
                     norm);
  }
}

std::vector<double> of_copies(const std::vector<contact::Field>& fields) {
  std::vector<double> u;
  for (const contact::Field& field : fields) u.insert(u.end(), field.u.begin(), field.u.end());
  return u;
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
  const estimate::LoadBalance balance =
      estimate::load_balance(cut, force, condensed.parts.traction);
  const estimate::EquilibratedFlux flux(cut, {u, balance.force, balance.traction});
  estimate::Bracket bracket = estimate::bracket(cut, flux, balance, lifts, u, answer.energy);
  answer.energy_lower = bracket.lower;
  answer.energy_upper = bracket.upper;
  answer.error_bound = bracket.error;
  answer.error_bound_relative = bracket.error_relative;
  add_intervals(*_parts, condensed, {cut, flux, balance, lifts, u}, answer);
  std::vector<double> indicator(bracket.indicator.size());
  for (std::size_t t = 0; t < indicator.size(); ++t)
    indicator[at(cut.triangle[t])] = bracket.indicator[t];
  return indicator;
}

}  // namespace anticrack::operators
