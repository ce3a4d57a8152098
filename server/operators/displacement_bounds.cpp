// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/displacement_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

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

/// The best of a few bounds of the cone, each wider than the one before.
class Search {
 public:
  Search(const Bounded& of, const contact::Adjoint& adjoint, const Aim& aim)
      : _of(of), _adjoint(adjoint), _aim(aim), _goal(adjoint.aim(aim.goal)) {
    const double norm = std::sqrt(of.primal.flux.norm_squared());
    _c = 2 * (norm > 0 ? std::sqrt(_goal.compliance) / norm : 1);
  }

  const Bounded& of() const { return _of; }
  const Aim& aim() const { return _aim; }
  bool held() const { return !(_goal.compliance > 0); }
  bool done() const { return held() || _tries == most_tries; }

  /// The next step needs the flux of an unloaded pair first.
  bool unloaded() const { return !_unloaded && !_of.primal.load.oscillation.empty(); }
  void set_unloaded(double norm) { _unloaded = norm; }

  contact::Adjoint::Pair pair() const { return _adjoint.clipped(_goal, unloaded() ? 0 : _c); }
  estimate::Aimed aimed(const AdjointFields& fields) const {
    return {&_of.primal, {fields[0], fields[1], value(), _c}, _unloaded.value_or(0)};
  }

  void take(const estimate::Interval& one) {
    ++_tries;
    if (!std::isfinite(one.width())) {
      _c *= 8;
      return;
    }
    const bool better = one.width() < _best.width();
    if (better) _best.estimate = one.estimate;
    _best.lower = std::max(_best.lower, one.lower);
    _best.upper = std::min(_best.upper, one.upper);
    if (!better || !(one.short_of > 1)) _tries = most_tries;
    _c *= std::clamp(one.short_of, 1.5, 8.0);
  }

  /// False where none holds: forces that tie the sides of crossing cracks may leave any cone.
  bool finish() const {
    contact::InclusionAnswer& answer = _of.answer.inclusions[_aim.inclusion];
    if (!held() && !std::isfinite(_best.width())) return false;
    answer.*_aim.lower = held() ? value() : _best.lower;
    answer.*_aim.upper = held() ? value() : _best.upper;
    if (!held() && _aim.estimate != nullptr) answer.*_aim.estimate = _best.estimate;
    return true;
  }

 private:
  double value() const { return _of.answer.inclusions[_aim.inclusion].*_aim.value; }

  const Bounded& _of;
  const contact::Adjoint& _adjoint;
  const Aim& _aim;
  contact::Adjoint::Goal _goal;
  double _c = 0;
  std::optional<double> _unloaded;
  estimate::Interval _best;
  int _tries = 0;
};

/// A step of each.
void advance(const MeshOperator::Parts& parts, const estimate::CutMesh& cut,
             std::span<Search* const> searches) {
  std::vector<contact::Adjoint::Pair> pairs;
  for (const Search* search : searches) pairs.push_back(search->pair());
  const std::vector<AdjointFields> fields = adjoint_fields(parts, pairs);
  std::vector<estimate::Aimed> aimed;
  std::vector<Search*> of_aimed;
  for (std::size_t i = 0; i < searches.size(); ++i) {
    if (searches[i]->unloaded()) {
      searches[i]->set_unloaded(estimate::norm_of_flux(cut, fields[i][1]));
    } else {
      aimed.push_back(searches[i]->aimed(fields[i]));
      of_aimed.push_back(searches[i]);
    }
  }
  const std::vector<estimate::Interval> found = estimate::intervals(cut, aimed);
  for (std::size_t i = 0; i < found.size(); ++i) of_aimed[i]->take(found[i]);
}

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

std::vector<AdjointFields> adjoint_fields(const MeshOperator::Parts& parts,
                                          std::span<const contact::Adjoint::Pair> pairs) {
  std::vector<std::vector<Eigen::VectorXd>> traces;
  for (const contact::Adjoint::Pair& pair : pairs)
    for (const Eigen::VectorXd* of : {&pair.z, &pair.reacting})
      traces.push_back(parts.skeleton->scatter(*of));
  std::vector<AdjointFields> fields(pairs.size());
  for (std::size_t s = 0; s < parts.operators.size(); ++s) {
    const ddm::Subdomain& subdomain = parts.decomposition.subdomains[s];
    ddm::CondensedLoad none;
    none.z_interior.setZero(static_cast<Eigen::Index>(subdomain.interior));
    none.dirichlet.setZero(static_cast<Eigen::Index>(subdomain.dirichlet));
    const auto count = static_cast<Eigen::Index>(subdomain.node.size());
    std::vector<Eigen::VectorXd> values(traces.size(), Eigen::VectorXd(count));
    std::vector<ddm::SubdomainOperator::Solved> solved;
    for (std::size_t f = 0; f < traces.size(); ++f)
      solved.push_back({none, traces[f][s], values[f]});
    parts.operators[s].recover(solved);
    for (std::size_t f = 0; f < traces.size(); ++f) {
      std::vector<double>& field = fields[f / 2][f % 2];
      field.insert(field.end(), values[f].begin(), values[f].end());
    }
  }
  return fields;
}

std::vector<double> of_copies(const std::vector<contact::Field>& fields) {
  std::vector<double> u;
  for (const contact::Field& field : fields) u.insert(u.end(), field.u.begin(), field.u.end());
  return u;
}

void bound_displacements(const MeshOperator::Parts& parts, std::span<const Bounded> answers) {
  constexpr std::size_t most_inclusions = 16;  // a few solves each
  constexpr std::size_t together = 4;
  if (answers.empty() || parts.mesh->inclusions.size() > most_inclusions) return;
  const std::vector<Aim> goals = aims(parts);
  std::deque<contact::Adjoint> adjoints;
  std::deque<Search> searches;
  std::vector<std::pair<const Bounded*, const Aim*>> by_energy;
  for (const Bounded& of : answers) {
    const bool possible =
        parts.skeleton &&
        adjoints
            .emplace_back(*parts.skeleton,
                          contact::CaseLoads{of.load.subdomains, of.load.inclusion_forces},
                          of.answer)
            .possible();
    for (const Aim& aim : goals) {
      if (possible)
        searches.emplace_back(of, adjoints.back(), aim);
      else
        by_energy.emplace_back(&of, &aim);
    }
  }
  std::vector<Search*> active;
  auto next = searches.begin();
  for (;;) {
    std::erase_if(active, [](const Search* search) { return search->done(); });
    for (; active.size() < together && next != searches.end(); ++next)
      if (!next->done()) active.push_back(&*next);
    if (active.empty()) break;
    advance(parts, answers.front().primal.cut, active);
  }
  for (const Search& search : searches)
    if (!search.finish()) by_energy.emplace_back(&search.of(), &search.aim());
  for (const auto& [of, aim] : by_energy)
    Slopes(parts, of->load, of->primal, *of->answer.energy_lower, *of->answer.energy_upper,
           of->stop)
        .find(*aim, of->answer.inclusions[aim->inclusion]);
}

}  // namespace anticrack::operators
