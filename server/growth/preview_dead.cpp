// SPDX-License-Identifier: GPL-3.0-or-later
//
// Preview beside a dead load.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "ddm/decomposition.hpp"
#include "errors/errors.hpp"
#include "growth/preview.hpp"
#include "stop/stop.hpp"

namespace anticrack::growth {
namespace {

using Eigen::VectorXd;
using errors::Error;
using errors::Reason;

/// Values that change by less, over the largest of all, do not change the contact set: rounding.
constexpr double no_change = 1e-11;

/// How far ahead of a change of contact the next set is looked for, over t and the load at which
/// both loads are as large.
constexpr double first_step = 1e-9;

constexpr std::size_t most_pieces = 10'000;

}  // namespace

/// Refuses what is not scaled beside loads, or not followed.
void Preview::require_scalable() const {
  if (!_problem.conditions().rows().empty())
    throw Error(Reason::invalid_argument,
                "cracks cross, and beside a dead load fronts are followed only where none do: "
                "leave the dead load out, or end a crack before the other")
        .at("dead");
  for (const mesh::Motion& motion : _mesh.motions)
    if (motion.fixed.value_or(0) != 0)
      throw Error(Reason::invalid_argument,
                  "an inclusion is held at {}, which beside a dead load is neither dead nor "
                  "live: hold it at 0, or move it by a force",
                  errors::shown(*motion.fixed))
          .at("dead");
}

/// The dead load and t times the other.
Preview::Loaded Preview::together(double t) const {
  Loaded result;
  const Eigen::Vector2d factors(1, t);
  for (std::size_t s = 0; s < _products.size(); ++s) {
    result.subdomains.push_back(
        ddm::combine(std::array{&_dead->loads.subdomains[s], &_load.loads.subdomains[s]},
                     _products[s], factors));
    std::vector<double>& force =
        result.own_force.emplace_back(_dead->force[s].begin(), _dead->force[s].end());
    for (std::size_t i = 0; i < force.size(); ++i) force[i] += t * _load.force[s][i];
  }
  for (const std::vector<double>& force : result.own_force) result.force.emplace_back(force);
  for (const auto& [load, factor] : {std::pair(_dead, 1.0), {&_load, t}}) {
    const auto forces = load->loads.inclusion_forces;
    result.inclusion_forces.resize(std::max(result.inclusion_forces.size(), forces.size()));
    for (std::size_t j = 0; j < forces.size(); ++j) {
      add(result.inclusion_forces[j].on_nodes, forces[j].on_nodes, factor);
      add(result.inclusion_forces[j].on_holders, forces[j].on_holders, factor);
    }
  }
  result.loads = {result.subdomains, result.inclusion_forces};
  finish(result);
  return result;
}

/// What holds from t on as long as no contact changes. `step` is how far ahead of t the set is
/// looked for; it grows while that leads nowhere.
Piece Preview::piece(const std::vector<double>& rooms, const State& state, double t, int way,
                     double& step) {
  stop::look("growing cracks and delaminations");
  const contact::Reduced &dead = _dead_alone.reduced, &live = _live.reduced;
  const double ratio = dead.r.norm() / live.r.norm(),
               size = t + ratio > 0 && std::isfinite(ratio) ? t + ratio : 1;
  const double ahead = way > 0 ? t + step * size : std::max(t - step * size, t / 2);
  contact::Reduced load = live;
  load.r = dead.r + ahead * live.r;
  load.magnitude = dead.magnitude + ahead * live.magnitude;
  // The set under the dead load alone is far from those of other t.
  if (t == 0) std::swap(_closed, _closed_alone);
  const std::vector<char> closed = solve_contact(load).closed;
  if (t == 0) std::swap(_closed, _closed_alone);
  const std::array both{dead.r, live.r};
  const std::vector<contact::Opened> parts = _problem.solve_open(closed, both);
  if (!parts[0].solved || !parts[1].solved)
    throw Error(Reason::numerical,
                "a part of the membrane is held by contact only as the load changes: hold it, or "
                "leave the dead load out");
  Piece piece;
  piece.end = way > 0 ? std::numeric_limits<double>::infinity() : 0;
  for (const bool of_jumps : {true, false}) {
    const VectorXd &at_0 = of_jumps ? parts[0].d : parts[0].residual,
                   &change = of_jumps ? parts[1].d : parts[1].residual;
    const double sign = of_jumps ? 1 : -1;  // of what has to stay above 0
    double largest = 0;
    for (Eigen::Index i = 0; i < at_0.size(); ++i)
      largest = std::max(largest, std::abs(at_0[i]) + size * std::abs(change[i]));
    for (Eigen::Index i = 0; i < at_0.size(); ++i) {
      if ((closed[at(i)] == 0) != of_jumps || _tied[at(i)] != 0) continue;
      const double falls = -sign * way * change[i];
      if (falls * size <= no_change * largest) continue;
      const double left = std::max(sign * (at_0[i] + ahead * change[i]), 0.0) / falls;
      piece.end = way > 0 ? std::min(piece.end, ahead + left) : std::max(piece.end, ahead - left);
    }
  }
  step = std::abs(piece.end - ahead) > step * size ? first_step : 2 * step;

  const contact::Answer alone = answer_for(_dead_alone, parts[0].d),
                        change = answer_for(_live, parts[1].d);
  contact::Answer sum = alone;
  for (std::size_t s = 0; s < sum.fields.size(); ++s)
    for (std::size_t i = 0; i < sum.fields[s].u.size(); ++i)
      sum.fields[s].u[i] += change.fields[s].u[i];
  for (std::size_t j = 0; j < sum.inclusions.size(); ++j) {
    sum.inclusions[j].slope_x_mesh += change.inclusions[j].slope_x_mesh;
    sum.inclusions[j].slope_y_mesh += change.inclusions[j].slope_y_mesh;
  }
  piece.rates.resize(rooms.size());
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (state.fate[i] != Fate::grows) continue;
    const Place& here = place(i, state.at[i]);
    if (here.behind >= 0 && closed[at(here.behind)] != 0) continue;
    const auto at_0 = rates(here, rooms[i], _dead_alone, alone),
               of_square = rates(here, rooms[i], _live, change),
               at_1 = rates(here, rooms[i], _both, sum);
    for (std::size_t k = 0; k < at_0.size(); ++k)
      piece.rates[i].by_radius[k] = polarised(at_0[k], of_square[k], at_1[k]);
  }
  return piece;
}

Measured Preview::measure(const State& state, const Sought& sought) {
  tie(_fronts.stretches, state);
  std::vector<double> room_of;
  std::vector<char> grows;
  Measured unmeasured;
  bool complete = true;
  for (std::size_t i = 0; i < _fronts.fronts.size(); ++i) {
    grows.push_back(state.fate[i] == Fate::grows ? 1 : 0);
    room_of.push_back(grows[i] != 0 ? room(i, state) : 0);
    unmeasured.release.emplace_back();
    if (grows[i] == 0) continue;
    if (room_of[i] >= least_radius * place(i, state.at[i]).edge)
      unmeasured.release[i] = 0;
    else
      complete = false;
  }
  if (!complete) return unmeasured;
  std::map<std::pair<double, int>, Piece> pieces;
  double step = first_step;
  Driven driven = drive(
      [&](double t, int way) {
        if (const auto known = pieces.find({t, way}); known != pieces.end()) return known->second;
        if (pieces.size() > most_pieces)
          throw Error(Reason::numerical,
                      "contact changes more than {} times on the way to the next load: take a "
                      "coarser mesh along the paths",
                      most_pieces);
        return pieces[{t, way}] = piece(room_of, state, t, way, step);
      },
      sought, grows);
  const double least = *std::ranges::min_element(driven.starts);
  Measured measured = measure(state, together(std::isfinite(least) ? least : sought.highest));
  measured.driven = std::move(driven);
  return measured;
}

}  // namespace anticrack::growth
