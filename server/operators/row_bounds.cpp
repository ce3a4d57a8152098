// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/row_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/at.hpp"
#include "contact/dense.hpp"
#include "estimate/bracket.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

using contact::multiply;
using Eigen::Index;
using Eigen::VectorXd;

/// Products that cancel are wrong by this part of their terms.
constexpr double of_products = 1e-13;
constexpr double unlimited = std::numeric_limits<double>::infinity();

double square(double x) { return x * x; }
/// 0 where rounding has made it negative.
double root(double x) { return std::sqrt(std::max(0.0, x)); }

double quadratic(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                 const Eigen::Ref<const VectorXd>& x) {
  VectorXd product(x.size());
  multiply(matrix, x, product);
  return x.dot(product);
}

/// Sets what is 0 to rounding to 0: it has no sign, and would need a cone.
void drop_rounding(VectorXd& values, double largest) {
  const double rounding = 1e-12 * std::max(largest, values.lpNorm<Eigen::Infinity>());
  for (double& one : values)
    if (std::abs(one) <= rounding) one = 0;
}

/// The least c for jumps or forces of the sign of `sign`, which are at most `most` times `room`.
double least_cone(const VectorXd& values, double sign, double most, const VectorXd& room) {
  double c = 0;
  for (Index i = 0; i < values.size(); ++i)
    if (sign * values[i] > 0)
      c = std::max(c, room[i] > 0 ? std::min(sign * values[i] / room[i], most) : most);
  return c;
}

}  // namespace

RowBounds::RowBounds(const MeshOperator::Parts& parts, const SharedBounds& shared,
                     const contact::SweepLoads& loads)
    : _parts(parts), _of(shared), _loads(loads) {
  for (const contact::UnitForce& force : shared.unit) _unit.push_back(force.r);
  _summary.inclusions.resize(parts.mesh->inclusions.size());
}

void RowBounds::find(std::span<const double> coefficients, const contact::LcpAnswer& solution,
                     std::size_t row, contact::SweepColumns& rows) {
  _found.clear();
  if (!take(coefficients, solution, rows.energy[row]) || !aim(solution.closed)) return;
  for (Index k = 0; k < _of.goals; ++k) {
    stop::look("computing bounds of rows");
    const std::size_t inclusion = _of.inclusion[at(k)];
    const double value = rows.displacement[row * rows.inclusions + inclusion];
    double lower = value, upper = value;  // held
    if (_goals[at(k)].adjoint.compliance > 0) {
      lower = _found.emplace_back(bound(k, estimate::Side::lower, value)).bound.value;
      upper = _found.emplace_back(bound(k, estimate::Side::upper, value)).bound.value;
    }
    if (!std::isfinite(lower) || !std::isfinite(upper)) return;
    _summary.inclusions[inclusion].displacement_lower = lower;
    _summary.inclusions[inclusion].displacement_upper = upper;
  }
  rows.take_bounds(row, _summary);
}

/// Takes a solution, and bounds its energy; false if rounding or the range of numbers forbids it.
bool RowBounds::take(std::span<const double> c, const contact::LcpAnswer& solution, double energy) {
  const Index loads = _of.loads, contacts = _of.contacts, elastic = loads + contacts;
  const FacePressures& faces = _of.pressures;
  Row& row = _row;
  row.y.resize(elastic);
  row.y.head(loads) = Eigen::Map<const VectorXd>(c.data(), loads);
  row.y.tail(contacts) = solution.d.head(contacts);
  const auto d = row.y.tail(contacts);
  row.sizes = row.y.cwiseAbs();
  row.products.resize(_of.flux.rows());
  multiply(_of.flux.leftCols(elastic), row.y, row.products);
  const auto coefficients = row.y.head(loads);
  VectorXd& reaction = row.reaction;
  reaction.resize(contacts);
  multiply(_of.stiffness(), d, reaction);
  row.norm_squared = coefficients.dot(_of.strain.topLeftCorner(loads, loads) * coefficients +
                                      2 * _of.strain.block(0, loads, loads, contacts) * d) +
                     d.dot(reaction);
  reaction -= _loads.r * coefficients;
  row.divided = faces.divided(reaction).ends;
  row.traction = _of.traction * coefficients;
  row.forces = solution.lambda.head(contacts).cwiseMax(0.0);
  row.off = (reaction - row.forces).cwiseAbs();

  row.slope.resize(static_cast<Index>(faces.turns.size()));
  multiply(_of.turning.leftCols(elastic), row.y, row.slope);
  row.turned = faces.divided(row.forces);
  const VectorXd none = VectorXd::Zero(row.turned.ends.size()),
                 any = VectorXd::Constant(none.size(), unlimited);
  faces.turn(row.slope + faces.slopes_of_work(d), none, any, row.turned);
  const double pulling = -row.turned.ends.cwiseMin(0.0).sum();  // rounding
  row.turned.ends = row.turned.ends.cwiseMax(0.0);
  row.pressure = faces.work(row.turned.ends, d);

  row.unbalancing = _of.lack.head(elastic).dot(row.sizes);
  row.lack = row.unbalancing + _of.beyond * (row.off.sum() + pulling);
  row.work = _of.work.head(elastic).dot(row.sizes);
  const VectorXd overlap = faces.overlap * row.turned.by;
  row.terms = _of.norm.head(elastic).dot(row.sizes) + root(row.turned.by.dot(overlap));
  row.distance = std::max(0.0, row.y.dot(row.products.head(elastic)) +
                                   row.turned.by.dot(2 * row.slope + overlap)) +
                 of_products * square(row.terms);
  const auto sizes = row.sizes.head(loads);
  const double o = root(sizes.dot(_of.oscillation * sizes));
  row.unbalanced = {square(o), 0, o};
  if (o > 0) {
    const double near =
        root(quadratic(_of.unbalanced.flux.topLeftCorner(elastic, elastic), row.y)) +
        root(row.turned.by.dot(_of.unbalanced.overlap * row.turned.by));
    row.unbalanced.dual = root(sizes.dot(_of.unbalanced.oscillation * sizes));
    row.unbalanced.primal = std::min(row.unbalanced.dual * near, o * std::sqrt(row.distance));
  }

  const double largest = _of.largest.head(elastic).dot(row.sizes);
  if (!estimate::in_range(_of.largest_tension, largest) ||
      cancels(_loads.parts_energy(c), energy, row.norm_squared))
    return false;
  energy += reaction.dot(d) / 2;  // that of a solution has d'lambda = 0
  const double rounding =
      estimate::rounding_of(energy, row.norm_squared, _of.largest_tension, largest);
  const double eta =
      std::sqrt(row.distance + row.unbalanced.squared + 2 * row.unbalanced.primal) + row.lack;
  _summary.energy_lower = energy - square(eta) / 2 - row.pressure - rounding;
  _summary.energy_upper = energy + rounding;
  return std::isfinite(*_summary.energy_lower) && std::isfinite(*_summary.energy_upper);
}

/// Finds z_0 of each goal, with these contacts closed; false if a part is held by contact alone.
bool RowBounds::aim(const std::vector<char>& closed) {
  if (_of.goals == 0 || (!_goals.empty() && closed == _closed)) return true;
  _goals.clear();
  _closed = closed;
  const std::vector<contact::Opened> opened = _parts.contact->solve_open(closed, _unit);
  const contact::Adjoint adjoint(_parts.contact->conditions(), _closed);
  for (Index k = 0; k < _of.goals; ++k) {
    if (!opened[at(k)].solved) {
      _goals.clear();
      return false;
    }
    Goal& goal = _goals.emplace_back(Goal{adjoint.aim(_of.unit[at(k)], opened[at(k)]), {}});
    drop_rounding(goal.adjoint.jumps, _of.largest[_of.loads + _of.contacts + k]);
    drop_rounding(goal.adjoint.reactions, _unit[at(k)].lpNorm<Eigen::Infinity>());
    goal.pair = pair(k, goal.adjoint.jumps, goal.adjoint.reactions, false);
    // Each pressure stays on its side of 0, where no cone is needed.
    const VectorXd& ends = goal.pair.turned.ends;
    VectorXd least = ends.cwiseMin(0.0), most = ends.cwiseMax(0.0);
    for (Index i = 0; i < ends.size(); ++i) {
      if (!_of.pressures.closed_at(i, closed)) continue;
      if (ends[i] < 0) least[i] = -unlimited;
      if (ends[i] > 0) most[i] = unlimited;
    }
    _of.pressures.turn(goal.pair.slope, least, most, goal.pair.turned);
    finish(k, goal.pair);
  }
  return true;
}

/// z and tau with these jumps and forces, not turned yet.
RowBounds::Pair RowBounds::pair(Index goal, VectorXd jumps, VectorXd forces, bool clipped) const {
  const Index n = _of.contacts, unit = _of.loads + n + goal;
  const auto stiffness = _of.stiffness();
  Pair of;
  of.reacting = jumps;
  const VectorXd load = forces + _unit[at(goal)];
  VectorXd force(n), flux(n);
  multiply(stiffness, jumps, force);
  double off = 0;
  if (clipped) {
    multiply(_of.softness, load, of.reacting);
    of.shift = of.reacting - jumps;
    of.strain = root(of.shift.dot(load - force));
    off = _of.inexact * load.lpNorm<1>();
  } else {
    off = (force - load).lpNorm<1>();
  }
  multiply(_of.flux.block(_of.loads, _of.loads, n, n), of.reacting, flux);
  const auto own = _of.flux.col(unit).segment(_of.loads, n);
  of.square = of.reacting.dot(flux) + 2 * of.reacting.dot(own) + _of.flux(unit, unit);
  of.slope.resize(_of.turning.rows());
  multiply(_of.turning.middleCols(_of.loads, n), of.reacting, of.slope);
  of.slope += _of.turning.col(unit);
  const VectorXd sizes = of.reacting.cwiseAbs();
  of.terms = _of.norm.segment(_of.loads, n).dot(sizes) + _of.norm[unit];
  of.lack = _of.lack.segment(_of.loads, n).dot(sizes) + _of.lack[unit] + _of.beyond * off;
  of.turned = _of.pressures.divided(forces);
  if (clipped) {
    // tau balances the unit force and the forces: this is int grad (z' - z).(tau - T grad z'),
    // wrong by what tau lacks.
    const double mixed = _of.pressures.work(of.turned.ends, of.shift) - forces.dot(of.shift);
    of.square += 2 * mixed + of.strain * (of.strain + 2 * of.lack);
    of.terms += of.strain;
    of.slope += _of.pressures.slopes_of_work(of.shift);
  }
  of.largest = _of.largest[unit] + _of.largest.segment(_of.loads, n).dot(jumps.cwiseAbs());
  of.jumps = std::move(jumps);
  of.forces = std::move(forces);
  return of;
}

/// Adds what the turns do to |tau - T grad z|, and measures what it has with the weight.
void RowBounds::finish(Index goal, Pair& pair) const {
  const VectorXd overlap = _of.pressures.overlap * pair.turned.by;
  if (_of.unbalanced.flux.size() > 0) {
    const Index n = _of.contacts, first = _of.loads, unit = first + n + goal;
    const auto norm = [&](const Eigen::MatrixXd& of, const VectorXd& x) {
      return root(quadratic(of.block(first, first, n, n), x) +
                  2 * x.dot(of.col(unit).segment(first, n)) + of(unit, unit));
    };
    pair.near = norm(_of.unbalanced.flux, pair.reacting) +
                root(pair.turned.by.dot(_of.unbalanced.overlap * pair.turned.by));
    pair.steep = norm(_of.unbalanced.strain, pair.jumps);
    if (pair.shift.size() > 0)
      pair.near += root(quadratic(_of.unbalanced.strain.block(first, first, n, n), pair.shift));
  }
  pair.terms += root(pair.turned.by.dot(overlap));
  pair.square = std::max(0.0, pair.square + pair.turned.by.dot(2 * pair.slope + overlap)) +
                of_products * square(pair.terms);
}

/// The bound of A from one side, of estimate/interval.hpp; A on the mesh is `value`.
RowBounds::Found RowBounds::bound(Index goal, estimate::Side side, double value) const {
  const Goal& of = _goals[at(goal)];
  const double sign = side == estimate::Side::upper ? 1 : -1;
  const VectorXd d = _row.y.tail(_of.contacts);
  const contact::Adjoint adjoint(_parts.contact->conditions(), _closed);
  Found best;
  best.bound.value = sign * unlimited;
  // To choose among cones takes longer here than to try them.
  std::optional<estimate::Clipped> cone{
      {estimate::first_cone(of.adjoint.compliance, _row.norm_squared)}};
  for (int tries = 0; cone && tries < estimate::most_cones; ++tries) {
    const double most = cone->c;
    const contact::Adjoint::Room room{most * d, most * _row.forces};
    Found found{{}, {}, most};
    double c = least_cone(of.adjoint.jumps, sign, most, d);
    const bool needs_cone = c > 0 || least_cone(of.adjoint.reactions, -sign, most, _row.forces) > 0;
    if (needs_cone) {
      VectorXd jumps = adjoint.jumps(of.adjoint, sign, room),
               forces = adjoint.reactions(of.adjoint, sign, room);
      const bool clipped = jumps != of.adjoint.jumps || forces != of.adjoint.reactions;
      found.pair = pair(goal, std::move(jumps), std::move(forces), clipped);
      c = std::max(c, turn_within(goal, sign, most, found.pair));
    } else {
      found.pair = of.pair;
    }
    found.bound = estimate::bound_of(terms(goal, value, found.pair), side, c, most);
    const bool better = sign * found.bound.value < sign * best.bound.value;
    cone = needs_cone && better ? estimate::next_cone({}, *cone, found.bound) : std::nullopt;
    if (better) best = std::move(found);
  }
  return best;
}

/// What the bound by z and its tau is made of.
estimate::Terms RowBounds::terms(Index goal, double value, const Pair& z) const {
  const Row& row = _row;
  const Index n = _of.contacts, unit = _of.loads + n + goal;
  const auto sizes = row.sizes.head(_of.loads);
  const double o = std::sqrt(row.unbalanced.squared);
  estimate::Terms of;
  of.value = value;
  of.work = _of.pressures.work(z.turned.ends, row.y.tail(n));
  of.residual = row.traction[n + goal] + z.jumps.dot(row.traction.head(n) - row.forces);
  double shifted = 0;  // int grad (z' - z).(sigma - T grad u), sigma not turned
  if (z.shift.size() > 0)
    shifted =
        z.shift.dot(row.traction.head(n) - row.reaction) + _of.pressures.work(row.divided, z.shift);
  of.mixed = 0.5 * (row.products[unit] + z.reacting.dot(row.products.segment(_of.loads, n)) +
                    z.turned.by.dot(row.slope + _of.pressures.overlap * row.turned.by) +
                    row.turned.by.dot(z.slope) + shifted);
  of.distance = row.distance;
  of.square = z.square;
  of.pressure = row.pressure;
  of.s = row.lack;
  of.t = z.lack;
  of.unbalanced = row.unbalanced;
  of.unbalanced.dual = std::min(o * std::sqrt(z.square), row.unbalanced.dual * z.near);
  of.extra = z.steep * sizes.dot(_of.steep.col(goal)) +
             z.largest * sizes.dot(_of.moments.col(goal)) + row.work * z.largest +
             z.jumps.cwiseAbs().dot(row.off) + 0.5 * row.unbalancing * z.strain +
             of_products * z.terms * row.terms;
  return of;
}

/// Turns tau within the cone of c <= most, from a start with the shares of sigma at each end, which
/// is in it; returns the least c.
double RowBounds::turn_within(Index goal, double sign, double most, Pair& pair) const {
  const VectorXd& p = _row.turned.ends;
  const FacePressures& faces = _of.pressures;
  FacePressures::Turned& turned = pair.turned;
  for (Index k = 0; k < turned.by.size(); ++k) {
    const FacePressures::Turn& turn = faces.turns[at(k)];
    const std::int32_t force = faces.ends[at(turn.end[0])].force;
    if (force < 0 || !(_row.forces[force] > 0)) continue;
    turned.by[k] = _row.turned.by[k] * pair.forces[force] / _row.forces[force];
    for (const std::size_t one : {0, 1})
      if (turn.end[one] >= 0) turned.ends[turn.end[one]] += turn.sign[one] * turned.by[k];
  }
  VectorXd low = -most * p, high = most * p;
  for (Index i = 0; i < p.size(); ++i)
    if (faces.closed_at(i, _closed)) (sign > 0 ? high[i] : low[i]) = sign * unlimited;
  faces.turn(pair.slope, low, high, turned);
  double c = 0, off = 0;
  for (Index i = 0; i < p.size(); i += 2) {
    const double size = -sign * (turned.ends[i] + turned.ends[i + 1]), room = p[i] + p[i + 1];
    if (!(size > 0)) continue;
    off += std::max(0.0, size - most * room);
    c = std::max(c, size < most * room ? size / room : most);
  }
  pair.lack += _of.beyond * off;
  finish(goal, pair);
  return c;
}

}  // namespace anticrack::operators
