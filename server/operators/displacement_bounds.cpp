// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/displacement_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "base/at.hpp"
#include "contact/open_membrane.hpp"
#include "contact/trace_state.hpp"
#include "estimate/bracket.hpp"
#include "estimate/chord_gap.hpp"
#include "estimate/interval.hpp"
#include "operators/aims.hpp"
#include "operators/bound_search.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

constexpr const char* bounding_a = "computing bounds of A";

/// Fields of z and of z', without which there is no field of z either. Where nothing is clipped,
/// one field is both.
struct Fields {
  std::vector<std::vector<double>> z, reacting;
  std::vector<char> one;
};

/// z' by a factor with every contact open, or by solves for the contacts. Without Ways
/// (`bridged`) z' has to be in equilibrium to rounding by its own solve.
Fields fields_of(const MeshOperator::Parts& parts, const contact::OpenMembrane* open, bool bridged,
                 std::span<Search* const> searches) {
  std::vector<const ddm::Terms*> forces;
  std::vector<Eigen::VectorXd> loads;
  std::vector<contact::Displaced> displaced;
  std::vector<std::size_t> solved;
  Fields fields;
  fields.reacting.resize(searches.size());
  for (std::size_t i = 0; i < searches.size(); ++i) {
    const Search& search = *searches[i];
    displaced.push_back({&search.target().aim().goal, search.jumps()});
    fields.one.push_back(open == nullptr && bridged && !search.clips() ? 1 : 0);
    if (fields.one.back() != 0) continue;
    solved.push_back(i);
    forces.push_back(displaced.back().force);
    loads.push_back(open != nullptr ? search.reactions() : search.load());
  }
  if (open != nullptr) {
    fields.reacting = open->fields(forces, false, loads);
    fields.z = parts.contact->fields_of(displaced);
    return fields;
  }
  const std::vector<contact::Opened> opened = parts.contact->solve_open({}, loads);
  for (std::size_t k = 0; k < solved.size(); ++k) displaced.push_back({forces[k], opened[k].d});
  fields.z = parts.contact->fields_of(displaced);
  for (std::size_t k = 0; k < solved.size(); ++k)
    if (opened[k].solved) fields.reacting[solved[k]] = std::move(fields.z[searches.size() + k]);
  return fields;
}

/// Tries the present cone of each search.
void advance(const MeshOperator::Parts& parts, const estimate::CutMesh& cut,
             const contact::OpenMembrane* open, std::span<Search* const> searches) {
  stop::look(bounding_a);
  const Fields fields = fields_of(parts, open, std::isfinite(cut.ways.triangle), searches);
  std::vector<estimate::Aimed> aimed;
  std::vector<Search*> solved;
  for (std::size_t i = 0; i < searches.size(); ++i) {
    const std::vector<double>& reacting = (fields.one[i] != 0 ? fields.z : fields.reacting)[i];
    if (reacting.empty()) {
      searches[i]->give_up();
      continue;
    }
    solved.push_back(searches[i]);
    aimed.push_back(searches[i]->aimed(fields.z[i], reacting));
  }
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

/// Bounds A by the pairs that the mesh keeps (estimate/mesh_dual.hpp).
void bound_by_mesh_duals(const MeshOperator::Parts& parts, const std::vector<Aim>& goals,
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
    const std::vector<estimate::MeshDual>& duals = mesh_duals(parts, cut, goals);
    const estimate::PrimalNorms norms = estimate::primal_norms(of.primal, of.bracket);
    for (std::size_t k = 0; k < goals.size(); ++k) {
      const double value = goals[k].value_in(of.answer), norm = duals[k].norm,
                   half = estimate::half_width(duals[k], norms);
      const double rounding = half > 0 ? 1e-12 * std::abs(value) : 0;
      if (!std::isfinite(half)) continue;
      goals[k].set_scale(of.answer, norm * norm, std::sqrt(of.primal.flux.norm_squared()));
      goals[k].set(of.answer, value - half - rounding, value + half + rounding);
    }
  }
}

/// Replaces the indicator of an answer by the parts of the triangles in the errors of A.
void indicate(const Bounded& of, const estimate::CutMesh& cut, const std::deque<Search>& searches) {
  double largest = 0;
  for (const contact::InclusionAnswer& one : of.answer.inclusions)
    largest = std::max(largest, std::abs(one.displacement));
  std::vector<double> sum(cut.triangle_count());
  bool any = false;
  for (const Search& search : searches) {
    const Aim& aim = search.target().aim();
    if (&search.target().adjoints.of != &of || aim.estimate == nullptr) continue;
    const contact::InclusionAnswer& one = of.answer.inclusions[aim.inclusion];
    if (!one.displacement_lower || !(*one.displacement_upper > *one.displacement_lower)) continue;
    const double size = *of.of_largest ? largest : std::abs(one.displacement);
    const double factor =
        contact::error_of(one, size) / (*one.displacement_upper - *one.displacement_lower);
    const std::vector<double>& parts = search.best().parts;
    for (std::size_t t = 0; t < parts.size(); ++t) sum[t] += factor * parts[t];
    any = any || !parts.empty();
  }
  for (std::size_t t = 0; any && t < sum.size(); ++t) (*of.indicator)[at(cut.triangle[t])] = sum[t];
}

/// Estimates what chords do to A, by z_0 of each target.
void estimate_chord_gaps(const MeshOperator::Parts& parts, const estimate::CutMesh& cut,
                         const std::deque<Target>& targets) {
  for (const Target& target : targets) {
    const Bounded& of = target.adjoints.of;
    if (target.aim().estimate == nullptr || of.stop.stop_requested()) continue;
    const contact::Displaced z_0{&target.aim().goal, target.goal.jumps};
    const std::vector<double> z = parts.contact->fields_of({&z_0, 1}).front();
    of.answer.inclusions[target.aim().inclusion].displacement_geometry_error =
        estimate::chord_gap(cut, parts.decomposition.subdomains, of.primal.load,
                            {of.primal.u, of.across_chords}, {z, {}});
  }
}

void bound_by_adjoints(const MeshOperator::Parts& parts, const std::vector<Aim>& goals,
                       std::span<const Bounded> answers) {
  constexpr std::size_t together = 4;
  constexpr std::size_t few = 8;  // another factor costs more than conjugate gradients
  const estimate::CutMesh& cut = answers.front().primal.cut;
  const std::vector<contact::UnitForce> forces = unit_forces(parts, goals);
  std::vector<Eigen::VectorXd> r;
  r.reserve(forces.size());
  for (const contact::UnitForce& force : forces) r.push_back(force.r);
  std::unique_ptr<const contact::OpenMembrane> open;
  // Ways lead out what one solve leaves.
  const bool factors =
      !parts.contact->condensed() && goals.size() > few && std::isfinite(cut.ways.triangle);
  const Working counted(parts.at_work, factors ? parts.contact->bytes() : 0);
  if (factors) open = parts.contact->open_membrane();
  std::deque<Adjoints> adjoints;
  std::deque<Target> targets;
  std::deque<Search> searches;
  std::vector<std::pair<const Bounded*, const Aim*>> by_energy;
  for (const Bounded& of : answers) {
    if (of.stop.stop_requested()) continue;
    stop::look(bounding_a);
    const std::vector<char>& closed = of.answer.closed;
    Adjoints& own = adjoints.emplace_back(
        Adjoints{of, {parts.contact->conditions(), closed}, room_of(parts, of.primal, closed)});
    // z_0 need not be exact where there are many.
    const std::vector<contact::Opened> opened =
        parts.contact->solve_open(closed, r, factors ? 1e-4 : 0);
    for (std::size_t k = 0; k < goals.size(); ++k) {
      if (!opened[k].solved) {
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
  if (!cut.chords.empty()) estimate_chord_gaps(parts, cut, targets);
  std::vector<Search*> active;
  auto next = searches.begin();
  for (;;) {
    std::erase_if(active, [](const Search* search) { return search->done(); });
    for (; active.size() < together && next != searches.end(); ++next)
      if (!next->done()) active.push_back(&*next);
    if (active.empty()) break;
    advance(parts, cut, open.get(), active);
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
  for (const Bounded& of : answers)
    if (of.of_largest && !of.stop.stop_requested()) indicate(of, cut, searches);
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
  std::size_t copies = 0;
  for (const contact::Field& field : fields) copies += field.u.size();
  std::vector<double> u;
  u.reserve(copies);
  for (const contact::Field& field : fields) u.insert(u.end(), field.u.begin(), field.u.end());
  return u;
}

void bound_displacements(const MeshOperator::Parts& parts, std::span<const Bounded> answers) {
  // Adjoints take a few solves for each displacement and load: some 10 s of one core for the most
  // goals times triangles, if A is to be close, otherwise 1 s.
  constexpr std::size_t most_inclusions = 16, most_work = 1'500'000, most_close = 16'000'000;
  if (answers.empty() || parts.mesh->inclusions.empty()) return;
  const std::vector<Aim> goals = aims(parts);
  const std::size_t work = goals.size() * answers.front().primal.cut.triangle_count();
  std::vector<Bounded> closely, others;
  for (const Bounded& of : answers) {
    const bool few = parts.mesh->inclusions.size() <= most_inclusions ||
                     work <= (of.closely ? most_close : most_work);
    (few ? closely : others).push_back(of);
  }
  if (!closely.empty()) bound_by_adjoints(parts, goals, closely);
  if (!others.empty()) bound_by_mesh_duals(parts, goals, others);
  if (answers.front().primal.cut.chords.empty()) return;
  for (const Bounded& of : answers)
    for (contact::InclusionAnswer& one : of.answer.inclusions)
      if (one.displacement_scale && !one.displacement_geometry_error)
        one.displacement_geometry_error = *one.displacement_scale * 2 *
                                          *of.answer.energy_geometry_error /
                                          of.primal.flux.norm_squared();
}

}  // namespace anticrack::operators
