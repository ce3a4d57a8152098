// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/displacement_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "contact/trace_state.hpp"
#include "estimate/bracket.hpp"
#include "mesh/at.hpp"

namespace anticrack::operators {
namespace {

/// A displacement of an inclusion, the unit force that works on it, and where its bounds go.
struct Aim {
  const ddm::Terms& goal;
  std::size_t inclusion;
  fem::Load force;
  double contact::InclusionAnswer::*value;
  std::optional<double> contact::InclusionAnswer::*lower, contact::InclusionAnswer::*upper;
  std::optional<double> contact::InclusionAnswer::*estimate = nullptr;
};

std::vector<Aim> aims(const MeshOperator::Parts& parts) {
  using Of = contact::InclusionAnswer;
  std::vector<Aim> aims;
  for (std::size_t j = 0; j < parts.mesh->inclusions.size(); ++j) {
    const ddm::RigidMotion& motion = parts.decomposition.skeleton.motions[j];
    const auto moment = [&](const fem::Moment& unit) {
      fem::Load force;
      force.inclusion_moments[parts.mesh->inclusions[j]] = unit;
      return force;
    };
    fem::Load force;
    force.inclusion_forces[parts.mesh->inclusions[j]] = 1;
    aims.push_back({motion.displacement, j, force, &Of::displacement, &Of::displacement_lower,
                    &Of::displacement_upper, &Of::displacement_estimated_error});
    if (!motion.slope_x.empty())
      aims.push_back({motion.slope_x, j, moment({1, 0}), &Of::slope_x, &Of::slope_x_lower,
                      &Of::slope_x_upper});
    if (!motion.slope_y.empty())
      aims.push_back({motion.slope_y, j, moment({0, 1}), &Of::slope_y, &Of::slope_y_lower,
                      &Of::slope_y_upper});
  }
  return aims;
}

/// Bounds of the cone that are tried; most answers need two.
constexpr int most_tries = 4;

class Intervals {
 public:
  Intervals(const MeshOperator::Parts& parts, const contact::Adjoint& adjoint,
            const estimate::Primal& primal)
      : _parts(parts),
        _primal(primal),
        _adjoint(adjoint),
        _norm(std::sqrt(primal.flux.norm_squared())) {}

  /// The best of a few bounds of the cone, each wider than the one before. False where none holds:
  /// forces that tie the sides of crossing cracks may leave any cone.
  bool find(const Aim& aim, contact::InclusionAnswer& answer) const {
    const contact::Adjoint::Goal goal = _adjoint.aim(aim.goal);
    if (!(goal.compliance > 0)) {  // held
      answer.*aim.lower = answer.*aim.upper = answer.*aim.value;
      return true;
    }
    const double unit = _norm > 0 ? std::sqrt(goal.compliance) / _norm : 1;
    double unloaded = 0;
    if (!_primal.load.oscillation.empty()) {
      const contact::Adjoint::Pair pair = _adjoint.clipped(goal, 0);
      unloaded = estimate::norm_of_flux(_primal.cut, adjoint_fields(_parts, pair)[1]);
    }
    estimate::Interval best;
    double c = 2 * unit;
    for (int tries = 0; tries < most_tries; ++tries) {
      const contact::Adjoint::Pair pair = _adjoint.clipped(goal, c);
      const auto [z, reacting] = adjoint_fields(_parts, pair);
      const estimate::Interval one =
          estimate::interval(_primal, {z, reacting, answer.*aim.value, c}, unloaded);
      if (!std::isfinite(one.width())) {
        c *= 8;
        continue;
      }
      const bool better = one.width() < best.width();
      if (better) best.estimate = one.estimate;
      best.lower = std::max(best.lower, one.lower);
      best.upper = std::min(best.upper, one.upper);
      if (!better || !(one.short_of > 1)) break;
      c *= std::clamp(one.short_of, 1.5, 8.0);
    }
    if (!std::isfinite(best.width())) return false;
    answer.*aim.lower = best.lower;
    answer.*aim.upper = best.upper;
    if (aim.estimate != nullptr) answer.*aim.estimate = best.estimate;
    return true;
  }

 private:
  const MeshOperator::Parts& _parts;
  const estimate::Primal& _primal;
  const contact::Adjoint& _adjoint;
  double _norm;
};

class UntilStopped final : public contact::Observer {
 public:
  explicit UntilStopped(const std::stop_token& stop) : _stop(stop) {}
  bool on_iteration(const contact::Sample&) override { return !_stop.stop_requested(); }

 private:
  const std::stop_token& _stop;
};

/// Pi is concave in the force F on a displacement A, and dPi/dF = -A, whatever the contact: with
/// bounds lo and hi of Pi, and any d > 0,
///
///   (lo(F - d) - hi(F)) / d <= A <= (hi(F) - lo(F + d)) / d;   narrow for d^2 = 2 (hi - lo) / k,
///
/// k the displacement of a unit force alone.
class Slopes {
 public:
  Slopes(const MeshOperator::Parts& parts, const LoadOnTraces& load, const estimate::Primal& primal,
         double lower, double upper, const std::stop_token& stop)
      : _parts(parts),
        _load(load),
        _primal(primal),
        _upper(upper),
        _gap(upper - lower),
        _stop(stop) {}

  void find(const Aim& aim, contact::InclusionAnswer& answer) const {
    const fem::Load* const force[] = {&aim.force};
    const CondensedOutcome condensed = condense_loads(force, *_parts.mesh, _parts.decomposition,
                                                      _parts.condense(), _parts.neumann, _stop)
                                           .front();
    const auto* unit = std::get_if<LoadOnTraces>(&condensed);
    if (unit == nullptr) return;
    const contact::Answer alone = solve({unit->subdomains, unit->inclusion_forces}, false);
    const double compliance = alone.inclusions[aim.inclusion].*aim.value;
    if (alone.status != contact::Status::converged || !(compliance > 0)) return;
    const double d = std::sqrt(2 * _gap / compliance);
    const std::optional<double> below = lower_with(*unit, -d), above = lower_with(*unit, d);
    if (!(d > 0) || !below || !above) return;
    answer.*aim.lower = (*below - _upper) / d;
    answer.*aim.upper = (_upper - *above) / d;
  }

 private:
  contact::Answer solve(const contact::CaseLoads& loads, bool fields) const {
    UntilStopped observer(_stop);
    return _parts.with_problem([&](const auto& problem) {
      return contact::solve_active_set(problem, *_parts.mesh, loads, {}, fields, observer);
    });
  }

  /// lo of the load and so many unit forces.
  std::optional<double> lower_with(const LoadOnTraces& unit, double forces) const {
    LoadOnTraces sum;
    sum.subdomains = _load.subdomains;
    sum.inclusion_forces = _load.inclusion_forces;
    for (std::size_t s = 0; s < sum.subdomains.size(); ++s) {
      sum.subdomains[s].z_interior += forces * unit.subdomains[s].z_interior;
      sum.subdomains[s].g += forces * unit.subdomains[s].g;
    }
    for (std::size_t j = 0; j < sum.inclusion_forces.size(); ++j) {
      add(sum.inclusion_forces[j].on_nodes, unit.inclusion_forces[j].on_nodes, forces);
      add(sum.inclusion_forces[j].on_holders, unit.inclusion_forces[j].on_holders, forces);
    }
    const contact::Answer answer = solve({sum.subdomains, sum.inclusion_forces}, true);
    if (!bounded(answer)) return std::nullopt;
    const std::vector<double> u = of_copies(answer.fields);
    const auto& [cut, of_load, load, lifts, of_answer] = _primal;
    const estimate::EquilibratedFlux flux(cut, {u, load.force, load.traction});
    return estimate::bracket(cut, flux, load, lifts, u, answer.energy).lower;
  }

  const MeshOperator::Parts& _parts;
  const LoadOnTraces& _load;
  const estimate::Primal& _primal;
  double _upper, _gap;
  const std::stop_token& _stop;
};

}  // namespace

bool bounded(const contact::Answer& answer) {
  constexpr double most_kkt = 1e-10;
  return answer.status == contact::Status::converged &&
         contact::within(answer.kkt_relative, most_kkt);
}

std::array<std::vector<double>, 2> adjoint_fields(const MeshOperator::Parts& parts,
                                                  const contact::Adjoint::Pair& pair) {
  const std::array<std::vector<Eigen::VectorXd>, 2> traces{parts.skeleton->scatter(pair.z),
                                                           parts.skeleton->scatter(pair.reacting)};
  std::array<std::vector<double>, 2> fields;
  for (std::size_t s = 0; s < parts.operators.size(); ++s) {
    const ddm::Subdomain& subdomain = parts.decomposition.subdomains[s];
    ddm::CondensedLoad none;
    none.z_interior.setZero(static_cast<Eigen::Index>(subdomain.interior));
    none.dirichlet.setZero(static_cast<Eigen::Index>(subdomain.dirichlet));
    const auto count = static_cast<Eigen::Index>(subdomain.node.size());
    std::array<Eigen::VectorXd, 2> values{Eigen::VectorXd(count), Eigen::VectorXd(count)};
    std::array<ddm::SubdomainOperator::Solved, 2> both{
        {{none, traces[0][s], values[0]}, {none, traces[1][s], values[1]}}};
    parts.operators[s].recover(both);
    for (std::size_t f = 0; f < 2; ++f)
      fields[f].insert(fields[f].end(), values[f].begin(), values[f].end());
  }
  return fields;
}

std::vector<double> of_copies(const std::vector<contact::Field>& fields) {
  std::vector<double> u;
  for (const contact::Field& field : fields) u.insert(u.end(), field.u.begin(), field.u.end());
  return u;
}

void bound_displacements(const MeshOperator::Parts& parts, const LoadOnTraces& load,
                         const estimate::Primal& primal, contact::Answer& answer,
                         const std::stop_token& stop) {
  constexpr std::size_t most_inclusions = 16;  // a few solves each
  if (answer.inclusions.size() > most_inclusions) return;
  std::optional<contact::Adjoint> adjoint;
  if (parts.skeleton)
    adjoint.emplace(*parts.skeleton, contact::CaseLoads{load.subdomains, load.inclusion_forces},
                    answer);
  const bool possible = adjoint && adjoint->possible();
  for (const Aim& aim : aims(parts)) {
    contact::InclusionAnswer& one = answer.inclusions[aim.inclusion];
    if (!possible || !Intervals(parts, *adjoint, primal).find(aim, one))
      Slopes(parts, load, primal, *answer.energy_lower, *answer.energy_upper, stop).find(aim, one);
  }
}

}  // namespace anticrack::operators
