// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/resultant_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "base/at.hpp"
#include "contact/solve.hpp"
#include "operators/bound_search.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

/// With z = 1 on a part of the Dirichlet boundary and 0 on the rest, the resultant there is
///
///   R(u) = a(u, z) - l(z) - <p_u, [z]> = -(A(u) of estimate/interval.hpp, with A(v) = 0)
///
/// where l(z) - a(v, z) has -R_h from the nodes of the part.
class UnitValue {
 public:
  UnitValue(const MeshOperator::Parts& parts, const std::vector<Eigen::VectorXd>& on_dirichlet)
      : _parts(parts) {
    for (std::size_t s = 0; s < on_dirichlet.size(); ++s) {
      const auto nodes = static_cast<Eigen::Index>(parts.decomposition.subdomains[s].node.size());
      _loads.push_back(std::move(
          parts.contact->loads(s, Eigen::MatrixXd::Zero(nodes, 1), on_dirichlet[s]).front()));
    }
    _reduced = parts.contact->reduce(_loads, Eigen::VectorXd(), true);
    _force = {nullptr, _reduced.r, 0};
  }

  const contact::UnitForce& force() const { return _force; }
  /// z in the copies of estimate::CutMesh, for jumps of the contacts.
  std::vector<double> field(const Eigen::VectorXd& d) const {
    const contact::ContactProblem& problem = *_parts.contact;
    const Eigen::VectorXd w = problem.values(problem.solve(_reduced, d), d, _reduced.p);
    contact::Answer answer;
    for (const Eigen::VectorXd& trace : problem.traces().scatter(w))
      answer.side_traces.emplace_back(trace.begin(), trace.end());
    const contact::SolvedCase solved{_loads, answer};
    problem.recover_fields({&solved, 1});
    return of_copies(answer.fields);
  }

 private:
  const MeshOperator::Parts& _parts;
  std::vector<ddm::CondensedLoad> _loads;
  contact::Reduced _reduced;
  contact::UnitForce _force;
};

/// Tries cones until the search is done.
void try_cones(const MeshOperator::Parts& parts, const UnitValue& value, Search& search) {
  while (!search.done()) {
    stop::look("computing bounds of forces");
    const std::vector<double> z = value.field(search.jumps());
    std::vector<double> reacting;
    if (search.clips()) {
      const Eigen::VectorXd load = search.load();
      const contact::Opened opened = parts.contact->solve_open({}, {&load, 1}).front();
      if (!opened.solved) break;
      reacting = value.field(opened.d);
    }
    const std::vector<double>& of_tau = reacting.empty() ? z : reacting;
    const estimate::Aimed aimed = search.aimed(z, of_tau);
    search.take(estimate::bounds(aimed.primal->cut, {&aimed, 1}).front());
  }
}

std::string bound_part(const MeshOperator::Parts& parts, const UnitValue& value, const Bounded& of,
                       contact::BoundaryAnswer& row) {
  const estimate::CutMesh& cut = of.primal.cut;
  const std::vector<char>& closed = of.answer.closed;
  const contact::Opened opened = parts.contact->solve_open(closed, {&value.force().r, 1}).front();
  if (!opened.solved) return "contact alone holds a part of the membrane";
  estimate::Primal primal = of.primal;
  primal.stiff = nullptr;
  const Bounded own{of.load, primal, of.bracket, of.answer, of.stop};
  Adjoints adjoints{own, {parts.contact->conditions(), closed}, room_of(parts, primal, closed)};
  static const ddm::Terms none;
  const std::vector<Aim> aim{
      Aim{none, 0, {}, nullptr, nullptr, nullptr, nullptr, nullptr, -row.resultant}};
  Target target{adjoints, aim, 0, std::vector<estimate::ForceOn>(parts.mesh->inclusions.size()),
                adjoints.adjoint.aim(value.force(), opened)};
  const std::vector<double> z = value.field(opened.d);
  target.goal.compliance = 0;  // |z|^2, which chooses the first cone
  for (std::size_t t = 0; t < cut.triangle_count(); ++t)
    target.goal.compliance += primal.flux.energy_of(t, z);
  // What is unknown of the load is led out by the Dirichlet boundary, where z is not 0 here. Forces
  // in nodes are sums of T grad u, whose rounding errors are relative to T |u|.
  const auto largest = [](std::span<const double> values) {
    double most = 0;
    for (const double one : values) most = std::max(most, std::abs(one));
    return most;
  };
  const double margin =
      (2 * primal.load.unknown + 1e-13 * cut.shapes.largest_tension * largest(primal.u)) *
      largest(z);
  double ends[2] = {};
  for (const estimate::Side side : {estimate::Side::lower, estimate::Side::upper}) {
    Search search(parts, target, side);
    try_cones(parts, value, search);
    if (own.stop.stop_requested()) return "";
    const double sign = side == estimate::Side::upper ? 1 : -1;
    ends[side == estimate::Side::upper ? 0 : 1] = -(search.best().value + sign * margin);
  }
  if (!std::isfinite(ends[0]) || !std::isfinite(ends[1])) return "the contacts leave every cone";
  row.resultant_lower = ends[0];
  row.resultant_upper = ends[1];
  return "";
}

}  // namespace

void bound_resultants(const MeshOperator::Parts& parts, std::span<const Bounded> answers) {
  constexpr std::size_t most_parts = 16;
  for (const Bounded& of : answers) {
    std::size_t done = 0;
    for (std::size_t k = 0; k < of.answer.boundary.size() && !of.stop.stop_requested(); ++k) {
      contact::BoundaryAnswer& row = of.answer.boundary[k];
      if (row.free) {
        row.no_bounds = "T du/dn is given there";
        continue;
      }
      const std::vector<Eigen::VectorXd> weights = parts.boundary_forces().isolated(k);
      if (weights.empty())
        row.no_bounds =
            "it meets another part where u is given: a force that is cut off there is "
            "infinite or depends on the mesh";
      else if (!parts.decomposition.skeleton.held.empty())
        row.no_bounds = "an inclusion is held at a number, or lies on the boundary";
      else if (!std::isfinite(of.primal.cut.ways.triangle))
        row.no_bounds = "contact alone holds a part of the membrane";
      else if (++done > most_parts)
        row.no_bounds = "there are more than 16 such parts";
      else
        row.no_bounds = bound_part(parts, UnitValue(parts, weights), of, row);
    }
  }
}

}  // namespace anticrack::operators
