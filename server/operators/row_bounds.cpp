// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/row_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "contact/dense.hpp"
#include "estimate/interval.hpp"

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

}  // namespace

RowBounds::RowBounds(const MeshOperator::Parts& parts, const SharedBounds& shared)
    : _parts(parts), _of(shared) {
  for (const contact::UnitForce& force : shared.unit) _unit.push_back(force.r);
  _summary.inclusions.resize(parts.mesh->inclusions.size());
}

void RowBounds::find(std::span<const double> coefficients, const contact::LcpAnswer& solution,
                     std::size_t row, contact::SweepColumns& rows) {
  if (!take(coefficients, solution, rows.energy[row]) || !aim(solution.closed)) return;
  for (Index k = 0; k < _of.goals; ++k) {
    const std::size_t inclusion = _of.inclusion[at(k)];
    const double value = rows.displacement[row * rows.inclusions + inclusion];
    double lower = value, upper = value;  // held
    if (_goals[at(k)].compliance > 0) {
      lower = bound(k, -1, value);
      upper = bound(k, 1, value);
    }
    if (!std::isfinite(lower) || !std::isfinite(upper)) return;
    _summary.inclusions[inclusion].displacement_lower = lower;
    _summary.inclusions[inclusion].displacement_upper = upper;
  }
  rows.take_bounds(row, _summary);
}

/// The pressure at the ends of faces, before it is turned.
VectorXd RowBounds::at_ends(const VectorXd& forces) const {
  VectorXd ends(static_cast<Index>(_of.ends.size()));
  for (Index i = 0; i < ends.size(); ++i) {
    const SharedBounds::End& end = _of.ends[at(i)];
    ends[i] = end.force >= 0 ? end.part * forces[end.force] : 0;
  }
  return ends;
}

/// int p [u], u with the jumps given.
double RowBounds::work(const VectorXd& ends, const Eigen::Ref<const VectorXd>& jumps) const {
  double sum = 0;
  for (Index i = 0; i < ends.size(); ++i)
    if (const std::int32_t jump = _of.ends[at(i)].jump; jump >= 0)
      sum += 0.5 * (ends[i] + ends[i ^ 1]) * jumps[jump];
  return sum;
}

/// Its derivatives with respect to the turns, which are int phi_k.grad u as well.
VectorXd RowBounds::slopes_of_work(const Eigen::Ref<const VectorXd>& jumps) const {
  VectorXd slopes = VectorXd::Zero(static_cast<Index>(_of.turns.size()));
  for (Index k = 0; k < slopes.size(); ++k) {
    const SharedBounds::Turn& turn = _of.turns[at(k)];
    for (const std::size_t one : {0, 1}) {
      if (turn.end[one] < 0) continue;
      for (const std::int32_t end : {turn.end[one], turn.end[one] ^ 1})
        if (const std::int32_t jump = _of.ends[at(end)].jump; jump >= 0)
          slopes[k] += 0.5 * turn.sign[one] * jumps[jump];
    }
  }
  return slopes;
}

/// Turns the flux about one node after the other towards the least distance, with the pressures
/// within their bounds, or no farther from them.
void RowBounds::turn(const VectorXd& slope, const VectorXd& least, const VectorXd& most,
                     Turned& turned) const {
  constexpr int sweeps = 3;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (Index k = 0; k < slope.size(); ++k) {
      const SharedBounds::Turn& turn = _of.turns[at(k)];
      double low = -unlimited, high = unlimited;
      for (const std::size_t one : {0, 1}) {
        if (turn.end[one] < 0) continue;
        const Index end = turn.end[one];
        const double down = least[end] - turned.ends[end], up = most[end] - turned.ends[end];
        low = std::max(low, turn.sign[one] > 0 ? down : -up);
        high = std::min(high, turn.sign[one] > 0 ? up : -down);
      }
      low = std::min(low, 0.0);
      high = std::max(high, 0.0);
      if (low == high) continue;
      double now = slope[k], softness = 0;
      for (Eigen::SparseMatrix<double>::InnerIterator one(_of.overlap, k); one; ++one) {
        now += one.value() * turned.by[one.row()];
        if (one.row() == k) softness = one.value();
      }
      const double step = std::clamp(-now / softness, low, high);
      turned.by[k] += step;
      for (const std::size_t one : {0, 1})
        if (turn.end[one] >= 0) turned.ends[turn.end[one]] += turn.sign[one] * step;
    }
  }
}

/// Takes a solution, and bounds its energy; false if rounding or the range of numbers forbids it.
bool RowBounds::take(std::span<const double> c, const contact::LcpAnswer& solution, double energy) {
  constexpr double least = 1e-250, most = 1e280, most_cancelled = 1e3;
  const Index loads = _of.loads, contacts = _of.contacts, elastic = loads + contacts;
  Row& row = _row;
  row.y.resize(elastic);
  row.y.head(loads) = Eigen::Map<const VectorXd>(c.data(), loads);
  row.y.tail(contacts) = solution.d.head(contacts);
  const auto d = row.y.tail(contacts);
  row.sizes = row.y.cwiseAbs();
  const VectorXd of_loads = row.sizes.head(loads);
  row.off_gradients.resize(0);
  row.beyond = 0;
  row.products.resize(_of.flux.rows());
  multiply(_of.flux.leftCols(elastic), row.y, row.products);
  VectorXd strain(elastic);
  multiply(_of.strain.topLeftCorner(elastic, elastic), row.y, strain);
  row.norm_squared = row.y.dot(strain);
  row.actual.resize(contacts);
  row.forces = solution.lambda.head(contacts).cwiseMax(0.0);
  multiply(_of.stiffness(), d, row.actual);
  row.actual -= _of.r * row.y.head(loads);
  double off = (row.actual - row.forces).lpNorm<1>();

  row.slope.resize(static_cast<Index>(_of.turns.size()));
  multiply(_of.turning.leftCols(elastic), row.y, row.slope);
  row.turned = {at_ends(row.forces), VectorXd::Zero(row.slope.size())};
  const VectorXd none = VectorXd::Zero(row.turned.ends.size()),
                 any = VectorXd::Constant(none.size(), unlimited);
  turn(row.slope + slopes_of_work(d), none, any, row.turned);
  off -= row.turned.ends.cwiseMin(0.0).sum();  // rounding
  row.turned.ends = row.turned.ends.cwiseMax(0.0);
  row.pressure = work(row.turned.ends, d);

  row.lack = _of.lack.head(elastic).dot(row.sizes) + _of.beyond * off;
  row.work = _of.work.head(elastic).dot(row.sizes);
  const VectorXd overlap = _of.overlap * row.turned.by;
  row.terms = _of.norm.head(elastic).dot(row.sizes) + root(row.turned.by.dot(overlap));
  row.distance = std::sqrt(std::max(0.0, row.y.dot(row.products.head(elastic)) +
                                             row.turned.by.dot(2 * row.slope + overlap)) +
                           of_products * square(row.terms));
  row.oscillation = root(of_loads.dot(_of.oscillation * of_loads));
  row.reach = row.oscillation;
  if (row.oscillation > 0) {
    row.reach = root(of_loads.dot(_of.unbalanced.oscillation * of_loads));
    const double near =
        root(quadratic(_of.unbalanced.flux.topLeftCorner(elastic, elastic), row.y)) +
        root(row.turned.by.dot(_of.unbalanced.overlap * row.turned.by));
    row.beyond =
        square(row.oscillation) + 2 * std::min(row.reach * near, row.oscillation * row.distance);
  }

  const double largest = _of.largest.head(elastic).dot(row.sizes),
               range = _of.largest_tension * square(largest),
               cancelled = of_loads.dot(_of.magnitude * of_loads);
  if (!(range > least && range < most) ||
      !(cancelled <= most_cancelled * (std::abs(energy) + row.norm_squared)))
    return false;
  const double rounding = 1e-12 * (std::abs(energy) + row.norm_squared) + 1e-13 * range +
                          0.5 * std::abs(row.actual.dot(d));
  const double all = std::sqrt(square(row.distance) + row.beyond) + row.lack;
  _summary.energy_lower = energy - square(all) / 2 - row.pressure - rounding;
  _summary.energy_upper = energy + rounding;
  return std::isfinite(*_summary.energy_lower) && std::isfinite(*_summary.energy_upper);
}

/// Finds z_0 of each goal, with these contacts closed; false if a part is held by contact alone.
bool RowBounds::aim(const std::vector<char>& closed) {
  if (_of.goals == 0 || (!_goals.empty() && closed == _closed)) return true;
  _goals.clear();
  _closed = closed;
  const std::vector<contact::Opened> opened = _parts.contact->solve_open(closed, _unit);
  for (Index k = 0; k < _of.goals; ++k) {
    const contact::Opened& one = opened[at(k)];
    if (!one.solved) {
      _goals.clear();
      return false;
    }
    VectorXd jumps = one.d, forces = -one.residual;
    // What is 0 to rounding has no sign, and would need a cone.
    const double of_jumps = 1e-12 * std::max(_of.largest[_of.loads + _of.contacts + k],
                                             jumps.lpNorm<Eigen::Infinity>()),
                 of_forces = 1e-12 * std::max(_unit[at(k)].lpNorm<Eigen::Infinity>(),
                                              forces.lpNorm<Eigen::Infinity>());
    for (Index i = 0; i < _of.contacts; ++i) {
      if (closed[at(i)] != 0 || std::abs(jumps[i]) <= of_jumps) jumps[i] = 0;
      if (closed[at(i)] == 0 || std::abs(forces[i]) <= of_forces) forces[i] = 0;
    }
    Goal& goal = _goals.emplace_back();
    goal.compliance = _of.unit[at(k)].compliance + _unit[at(k)].dot(one.d);
    goal.pair = pair(k, std::move(jumps), std::move(forces), false);
    // Each pressure stays on its side of 0, where no cone is needed.
    const VectorXd& ends = goal.pair.turned.ends;
    VectorXd least = ends.cwiseMin(0.0), most = ends.cwiseMax(0.0);
    for (Index i = 0; i < ends.size(); ++i) {
      const std::int32_t own = _of.ends[at(i)].jump;
      const bool free = own >= 0 && closed[at(own)] != 0;
      if (ends[i] < 0)
        most[i] = 0, least[i] = free ? -unlimited : least[i];
      else if (ends[i] > 0)
        least[i] = 0, most[i] = free ? unlimited : most[i];
    }
    turn(goal.pair.slope, least, most, goal.pair.turned);
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
  if (clipped) {
    multiply(_of.softness, forces + _unit[at(goal)], of.reacting);
    of.shift = of.reacting - jumps;
  }
  VectorXd force(n), flux(n);
  multiply(stiffness, of.reacting, force);
  const double off = (force - _unit[at(goal)] - forces).lpNorm<1>();
  multiply(_of.flux.block(_of.loads, _of.loads, n, n), of.reacting, flux);
  const auto own = _of.flux.col(unit).segment(_of.loads, n);
  of.square = of.reacting.dot(flux) + 2 * of.reacting.dot(own) + _of.flux(unit, unit);
  of.slope.resize(_of.turning.rows());
  multiply(_of.turning.middleCols(_of.loads, n), of.reacting, of.slope);
  of.slope += _of.turning.col(unit);
  const VectorXd sizes = of.reacting.cwiseAbs();
  of.terms = _of.norm.segment(_of.loads, n).dot(sizes) + _of.norm[unit];
  if (clipped) {
    VectorXd mixed(n);
    multiply(_of.mixed.middleCols(_of.loads, n), of.reacting, mixed);
    mixed += _of.mixed.col(unit);
    multiply(stiffness, of.shift, force);
    const double strain = of.shift.dot(force);
    of.square += 2 * of.shift.dot(mixed) + strain;
    of.terms += root(strain);
    of.slope += slopes_of_work(of.shift);
  }
  of.lack = _of.lack.segment(_of.loads, n).dot(sizes) + _of.lack[unit] + _of.beyond * off;
  of.largest = _of.largest[unit] + _of.largest.segment(_of.loads, n).dot(jumps.cwiseAbs());
  of.turned = {at_ends(forces), VectorXd::Zero(of.slope.size())};
  of.jumps = std::move(jumps);
  of.forces = std::move(forces);
  return of;
}

/// Adds what the turns do to |tau - T grad z|, and measures what it has with the weight.
void RowBounds::finish(Index goal, Pair& pair) const {
  const VectorXd overlap = _of.overlap * pair.turned.by;
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

/// The bound of A on the side of `sign`, of estimate/interval.hpp; A on the mesh is `value`.
double RowBounds::bound(Index goal, double sign, double value) {
  constexpr int most_tries = 4;
  const Goal& of = _goals[at(goal)];
  Row& row = _row;
  const Index n = _of.contacts, unit = _of.loads + n + goal;
  const auto d = row.y.tail(n);
  double best = sign * unlimited;
  double most = 2 * (row.norm_squared > 0 ? std::sqrt(of.compliance / row.norm_squared) : 1);
  for (int tries = 0; tries < most_tries; ++tries) {
    // The pair of this cone, and the least c for it.
    VectorXd jumps = of.pair.jumps, forces = of.pair.forces;
    bool clipped = false;
    double c = 0;
    const auto clip = [&](double& one, double side, double room) {
      if (!(side * one > 0)) return;
      if (side * one > most * room) {
        one = side * most * room;
        clipped = true;
        c = most;
      } else {
        c = std::max(c, side * one / room);
      }
    };
    for (Index i = 0; i < n; ++i) {
      clip(jumps[i], sign, d[i]);
      clip(forces[i], -sign, row.forces[i]);
    }
    Pair own;
    const bool needs_cone = c > 0;
    if (needs_cone) own = pair(goal, std::move(jumps), std::move(forces), clipped);
    if (clipped && row.off_gradients.size() == 0) {
      row.off_gradients.resize(n);
      multiply(_of.mixed.leftCols(_of.loads + n), row.y, row.off_gradients);
    }
    if (needs_cone) c = std::max(c, turn_within(goal, sign, most, own));
    const Pair& z = needs_cone ? own : of.pair;

    const double turned =
        z.turned.by.dot(row.slope + _of.overlap * row.turned.by) + row.turned.by.dot(z.slope);
    const double mixed =
        0.5 * (row.products[unit] + z.reacting.dot(row.products.segment(_of.loads, n)) + turned +
               (clipped ? z.shift.dot(row.off_gradients) : 0));
    const double residual =
        (_of.traction.row(n + goal) + z.jumps.transpose() * _of.traction.topRows(n))
            .dot(row.y.head(_of.loads));
    const double middle = value + work(z.turned.ends, d) + residual + mixed;
    const double s = row.lack, t = z.lack, off = row.distance, dual = std::sqrt(z.square),
                 o = row.oscillation, all = std::sqrt(square(off) + row.beyond);
    const estimate::HalfWidth half{square((all + s) / 2) + row.pressure,
                                   std::min(o * dual, row.reach * z.near) / 2 + t * o / 2,
                                   square((dual + t) / 2)};
    const auto of_loads = row.sizes.head(_of.loads);
    const double moved = z.steep * of_loads.dot(_of.steep.col(goal)) +
                         z.largest * of_loads.dot(_of.moments.col(goal));
    const double lacking = row.work * z.largest + z.jumps.cwiseAbs().dot(row.actual.cwiseAbs()) +
                           0.5 * (dual * s + t * off + s * t);
    const double extra = moved + lacking + 1e-12 * (std::abs(value) + std::abs(middle)) +
                         of_products * z.terms * row.terms;
    const double found = middle + sign * (half(c) + extra);
    const double short_of = std::sqrt(half.dual / half.primal) / most;
    const bool better = sign * found < sign * best;
    if (better) best = found;
    if (!needs_cone || !better || !(short_of > 1)) break;
    most *= std::clamp(short_of, 1.5, 8.0);
  }
  return best;
}

/// Turns tau within the cone of c <= most, from a start with the shares of sigma at each end, which
/// is in it; returns the least c.
double RowBounds::turn_within(Index goal, double sign, double most, Pair& pair) const {
  const VectorXd& p = _row.turned.ends;
  Turned& turned = pair.turned;
  for (Index k = 0; k < turned.by.size(); ++k) {
    const SharedBounds::Turn& turn = _of.turns[at(k)];
    const std::int32_t force = _of.ends[at(turn.end[0])].force;
    if (force < 0 || !(_row.forces[force] > 0)) continue;
    turned.by[k] = _row.turned.by[k] * pair.forces[force] / _row.forces[force];
    for (const std::size_t one : {0, 1})
      if (turn.end[one] >= 0) turned.ends[turn.end[one]] += turn.sign[one] * turned.by[k];
  }
  VectorXd low = -most * p, high = most * p;
  for (Index i = 0; i < p.size(); ++i) {
    const std::int32_t own = _of.ends[at(i)].jump;
    if (own < 0 || _closed[at(own)] == 0) continue;
    (sign > 0 ? high[i] : low[i]) = sign * unlimited;
  }
  this->turn(pair.slope, low, high, turned);
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
