// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/displacement_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "contact/trace_state.hpp"
#include "estimate/bracket.hpp"
#include "estimate/interval.hpp"
#include "operators/aims.hpp"
#include "operators/bound_search.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

constexpr const char* bounding_a = "computing bounds of A";

/// Tries the present cone of each search.
void advance(const MeshOperator::Parts& parts, const estimate::CutMesh& cut,
             std::span<Search* const> searches) {
  std::vector<Eigen::VectorXd> loads;
  stop::look(bounding_a);
  for (const Search* search : searches) loads.push_back(search->load());
  const std::vector<contact::Opened> opened = parts.contact->solve_open({}, loads);
  std::vector<contact::Displaced> displaced;
  std::vector<Search*> solved;
  for (std::size_t i = 0; i < searches.size(); ++i) {
    if (!opened[i].solved) {
      searches[i]->give_up();
      continue;
    }
    solved.push_back(searches[i]);
    const ddm::Terms& force = searches[i]->target().aim().goal;
    displaced.push_back({&force, searches[i]->jumps()});
    displaced.push_back({&force, opened[i].d});
  }
  const std::vector<std::vector<double>> fields = parts.contact->fields_of(displaced);
  std::vector<estimate::Aimed> aimed;
  for (std::size_t i = 0; i < solved.size(); ++i)
    aimed.push_back(solved[i]->aimed(fields[2 * i], fields[2 * i + 1]));
  const std::vector<estimate::Bound> found = estimate::bounds(cut, aimed);
  for (std::size_t i = 0; i < found.size(); ++i) solved[i]->take(found[i]);
}

class UntilStopped final : public contact::Observer {
 public:
  bool on_iteration(const contact::Sample&) override {
    stop::look(bounding_a);
    return true;
  }
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
         double lower, double upper)
      : _parts(parts), _load(load), _primal(primal), _upper(upper), _gap(upper - lower) {}

  void find(const Aim& aim, contact::Answer& answer) const {
    const fem::Load load = aim.force(*_parts.mesh);
    const fem::Load* const force[] = {&load};
    const CondensedOutcome condensed =
        condense_loads(force, *_parts.mesh, _parts.decomposition, _parts.condense(), _parts.neumann)
            .front();
    const auto* unit = std::get_if<LoadOnTraces>(&condensed);
    if (unit == nullptr) return;
    const contact::Answer alone = solve({unit->subdomains, unit->inclusion_forces}, false);
    const double compliance = aim.value_in(alone);
    if (alone.status != contact::Status::converged || !(compliance > 0)) return;
    const double d = std::sqrt(2 * _gap / compliance);
    const std::optional<double> below = lower_with(*unit, -d), above = lower_with(*unit, d);
    if (!(d > 0) || !below || !above) return;
    aim.set_scale(answer, compliance, std::sqrt(_primal.flux.norm_squared()));
    aim.set(answer, (*below - _upper) / d, (_upper - *above) / d);
  }

 private:
  contact::Answer solve(const contact::CaseLoads& loads, bool fields) const {
    UntilStopped observer;
    return contact::solve_active_set(*_parts.contact, *_parts.mesh, loads, {}, fields, observer);
  }

  /// lo(F + forces), the lower bound of Pi for the load plus `forces` unit forces.
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
    const estimate::CutMesh& cut = _primal.cut;
    if (!bounded(answer, cut)) return std::nullopt;
    const std::vector<double> u = of_copies(answer.fields);
    const estimate::LoadBalance& load = _primal.load;
    const estimate::EquilibratedFlux flux(cut, {u, load.force, load.traction});
    return estimate::bracket(cut, flux, load, _primal.lifts, u, answer.energy_mesh,
                             lack_of(cut, flux, load, sum).flux)
        .lower;
  }

  const MeshOperator::Parts& _parts;
  const LoadOnTraces& _load;
  const estimate::Primal& _primal;
  double _upper, _gap;
};

/// A_h +- |tau| |u - u_h|, tau the flux of a unit force with every contact open: A - A_h is
/// int tau . grad (u - u_h), as tau carries nothing through contacts.
void bound_by_norms(const MeshOperator::Parts& parts, const std::vector<Aim>& goals,
                    std::span<const Bounded> answers) {
  // Goals times triangles: about a second, once for the mesh, after contact::OpenMembrane's factor.
  const std::size_t most_work = parts.contact->condensed() ? 30'000'000 : 20'000'000;
  const estimate::CutMesh& cut = answers.front().primal.cut;
  const bool possible = goals.size() <= most_work / cut.triangle_count();
  for (const Bounded& of : answers) {
    if (!possible) {
      of.answer.warnings.push_back(fmt::format(
          "no bounds of A: {} inclusions on {} triangles, more than {} of both multiplied; use a "
          "coarser mesh for them",
          parts.mesh->inclusions.size(), cut.triangle_count(), most_work));
      continue;
    }
    const std::vector<double>& norms = flux_norms(parts, cut, goals);
    for (std::size_t k = 0; k < goals.size(); ++k) {
      const double value = goals[k].value_in(of.answer), half = norms[k] * *of.answer.error_bound;
      const double rounding = half > 0 ? 1e-12 * std::abs(value) : 0;
      if (!std::isfinite(half)) continue;
      goals[k].set_scale(of.answer, norms[k] * norms[k], std::sqrt(of.primal.flux.norm_squared()));
      goals[k].set(of.answer, value - half - rounding, value + half + rounding);
    }
  }
}

void bound_by_adjoints(const MeshOperator::Parts& parts, const std::vector<Aim>& goals,
                       std::span<const Bounded> answers) {
  constexpr std::size_t together = 4;
  const estimate::CutMesh& cut = answers.front().primal.cut;
  const std::vector<contact::UnitForce> forces = unit_forces(parts, goals);
  std::vector<Eigen::VectorXd> r;
  r.reserve(forces.size());
  for (const contact::UnitForce& force : forces) r.push_back(force.r);
  std::deque<Adjoints> adjoints;
  std::deque<Target> targets;
  std::deque<Search> searches;
  std::vector<std::pair<const Bounded*, const Aim*>> by_energy;
  for (const Bounded& of : answers) {
    if (of.stop.stop_requested()) continue;
    stop::look(bounding_a);
    Adjoints& own = adjoints.emplace_back(Adjoints{of, contact::Adjoint(parts.problem, of.answer)});
    std::vector<contact::Opened> opened;
    if (own.adjoint.possible()) opened = parts.contact->solve_open(of.answer.closed, r);
    for (std::size_t k = 0; k < goals.size(); ++k) {
      if (!own.adjoint.possible() || !opened[k].solved) {
        by_energy.emplace_back(&of, &goals[k]);
        continue;
      }
      Target& target =
          targets.emplace_back(Target{own, goals, k, goals[k].unit(of.answer.inclusions.size()),
                                      own.adjoint.aim(forces[k], opened[k])});
      goals[k].set_scale(of.answer, target.goal.compliance,
                         std::sqrt(of.primal.flux.norm_squared()));
      if (!(target.goal.compliance > 0)) {  // held
        const double value = goals[k].value_in(of.answer);
        goals[k].set(of.answer, value, value);
        continue;
      }
      for (const estimate::Side side : {estimate::Side::lower, estimate::Side::upper})
        searches.emplace_back(parts, target, side);
    }
  }
  std::vector<Search*> active;
  auto next = searches.begin();
  for (;;) {
    std::erase_if(active, [](const Search* search) { return search->done(); });
    for (; active.size() < together && next != searches.end(); ++next)
      if (!next->done()) active.push_back(&*next);
    if (active.empty()) break;
    advance(parts, cut, active);
  }
  for (std::size_t i = 0; i < searches.size(); i += 2) {
    const Search &lower = searches[i], &upper = searches[i + 1];
    if (lower.stopped()) continue;
    // Forces that tie the sides of crossing cracks may leave any cone.
    const Bounded& of = lower.target().adjoints.of;
    const Aim& aim = lower.target().aim();
    if (!std::isfinite(lower.best().value) || !std::isfinite(upper.best().value)) {
      by_energy.emplace_back(&of, &aim);
      continue;
    }
    aim.set(of.answer, lower.best().value, upper.best().value);
    if (aim.estimate != nullptr)
      of.answer.inclusions[aim.inclusion].*aim.estimate = lower.best().estimate;
  }
  for (const auto& [of, aim] : by_energy) {
    if (of->stop.stop_requested()) continue;
    const stop::Scope scope(of->stop);
    try {
      Slopes(parts, of->load, of->primal, *of->answer.energy_lower, *of->answer.energy_upper)
          .find(*aim, of->answer);
    } catch (const errors::Error& error) {
      if (error.reason() != errors::Reason::cancelled || !of->stop.stop_requested()) throw;
    }
  }
}

}  // namespace

bool bounded(const contact::Answer& answer, const estimate::CutMesh& cut) {
  constexpr double most_kkt = 1e-10;
  return answer.status == contact::Status::converged &&
         (std::isfinite(cut.ways.triangle) || contact::within(answer.kkt_relative, most_kkt));
}

estimate::Lack lack_of(const estimate::CutMesh& cut, const estimate::EquilibratedFlux& flux,
                       const estimate::LoadBalance& balance, const LoadOnTraces& load) {
  if (!std::isfinite(cut.ways.triangle)) return {};
  return estimate::lack_of(cut, flux, balance.traction, forces_on(load),
                           estimate::pressing(cut, flux));
}

std::vector<estimate::ForceOn> forces_on(const LoadOnTraces& load) {
  std::vector<estimate::ForceOn> forces;
  for (const auto& [on_nodes, on_holders] : load.inclusion_forces)
    forces.push_back({on_nodes.force, {on_nodes.moment_x, on_nodes.moment_y}});
  return forces;
}

std::vector<double> of_copies(const std::vector<contact::Field>& fields) {
  std::vector<double> u;
  for (const contact::Field& field : fields) u.insert(u.end(), field.u.begin(), field.u.end());
  return u;
}

void bound_displacements(const MeshOperator::Parts& parts, std::span<const Bounded> answers) {
  constexpr std::size_t most_inclusions = 16;  // a few solves each for every load
  if (answers.empty() || parts.mesh->inclusions.empty()) return;
  const std::vector<Aim> goals = aims(parts);
  if (parts.mesh->inclusions.size() > most_inclusions)
    bound_by_norms(parts, goals, answers);
  else
    bound_by_adjoints(parts, goals, answers);
}

}  // namespace anticrack::operators
