// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/equilibrated_flux.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/triangle_rules.hpp"
#include "mesh/at.hpp"

namespace anticrack::estimate {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1]}; }
void add(Vector& to, double factor, const Vector& what) {
  to[0] += factor * what[0];
  to[1] += factor * what[1];
}
/// By coordinates, which are multiplied at once.
void add_product(Vector& to, const FanCorner& corner, const Vector& mean) {
  for (std::size_t d = 0; d < 2; ++d) to[d] += corner.compliance * (corner.edge[d] * mean[d]);
}
/// Outward normal of an edge of a counterclockwise triangle, as long as the edge.
Vector normal(const Vector& edge) { return {edge[1], -edge[0]}; }

constexpr std::size_t next(std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
constexpr std::size_t previous(std::size_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

}  // namespace

EquilibratedFlux::EquilibratedFlux(const CutMesh& cut, const Balance& balance, FaceBounds bounds,
                                   int polish_sweeps)
    : _cut(cut),
      _balance(balance),
      _is_pressure(bounds.empty()),
      _tension(cut.shapes.tension),
      _area(cut.shapes.area),
      _edge(cut.shapes.edge) {
  build(measure(), bounds);
  for (int sweep = 0; sweep < polish_sweeps; ++sweep) polish(bounds);
  turn();
}

/// Minus half the outward flux of T grad u through each side: with G = sum of u_i e_i, that of side
/// i is -T G.e_i / (2 area).
std::vector<double> EquilibratedFlux::measure() {
  const std::size_t count = _cut.triangle_count();
  std::vector<double> half(3 * count);
  _mean.assign(count, Vector{});
  if (!_balance.force.empty()) _rest.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    const std::int32_t* copy = &_cut.copy[3 * t];
    const Vector* edge = &_edge[3 * t];
    const double u = _balance.u[at(copy[0])], q = _cut.shapes.stiffness[t];
    Vector sum{};
    add(sum, _balance.u[at(copy[1])] - u, edge[1]);
    add(sum, _balance.u[at(copy[2])] - u, edge[2]);
    for (std::size_t i = 0; i < 3; ++i) half[3 * t + i] = q * dot(sum, edge[i]);
    _norm_squared += q * dot(sum, sum);
    if (!_rest.empty()) balance(t);
  }
  return half;
}

/// What the load makes of sigma - T grad u besides: d/2 (x - centroid) with the divergence d, and
/// the bubble  b = 1/3 sum_(i<j) (f_j - f_i)(P_j - P_i) l_i l_j,  div b = -(f - mean f), which has
/// no flux through the sides. With the loads f_i, their sum s and d_i = f_k - f_j this is a part
/// -(f_0 e_2 + f_1 e_0 + f_2 e_1) / (2 area) of the mean, and the square of what is left
///   1/area sum_i e_i.e_i (s^2 / 144 + (2 d_i^2 - d_j d_k - s (s - 3 f_i)) / 45).
void EquilibratedFlux::balance(std::size_t t) {
  const Vector* edge = &_edge[3 * t];
  const double* force = &_balance.force[3 * t];
  const double d[3] = {force[2] - force[1], force[0] - force[2], force[1] - force[0]};
  const double sum = force[0] + force[1] + force[2];
  add(_mean[t], d[2], edge[2]);
  add(_mean[t], -d[0], edge[1]);
  double rest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double bubble =
        2 * d[i] * d[i] - d[(i + 1) % 3] * d[(i + 2) % 3] - sum * (sum - 3 * force[i]);
    rest += dot(edge[i], edge[i]) * (1.0 / 144 * sum * sum + 1.0 / 45 * bubble);
  }
  _rest[t] = 4 * rest;
}

std::span<const Stop> EquilibratedFlux::stops(std::size_t fan) const {
  return std::span(_cut.stops)
      .subspan(at(_cut.first_stop[fan]), at(_cut.first_stop[fan + 1] - _cut.first_stop[fan]));
}

std::span<const FanCorner> EquilibratedFlux::corners(std::size_t fan) const {
  return std::span(_cut.shapes.around)
      .subspan(at(_cut.first_corner[fan]), at(_cut.first_corner[fan + 1] - _cut.first_corner[fan]));
}

double EquilibratedFlux::jump(std::size_t face, std::size_t end) const {
  const Face& own = _cut.faces[face];
  return _balance.u[at(_cut.ends(_cut.faces[at(own.other)])[1 - end])] -
         _balance.u[at(_cut.ends(own)[end])];
}

/// Derivative of int p [u] by the flux through the fan's spokes.
double EquilibratedFlux::slope_of_work(std::size_t fan) const {
  double slope = 0;
  if (!_is_pressure) return slope;
  for (const Stop& stop : stops(fan))
    if (presses(_cut.faces[at(stop.face)].condition))
      slope -= 0.5 * stop.sign() * (jump(at(stop.face), 0) + jump(at(stop.face), 1));
  return slope;
}

/// Changes the flux through the fan's spokes to the least distance that is allowed; how far.
double EquilibratedFlux::step(std::size_t fan, double slope, FaceBounds bounds) {
  const double best = -slope * _cut.shapes.softness[fan];
  if (stops(fan).empty()) return best;
  const double change = allowed(fan, best, bounds);
  for (const Stop& stop : stops(fan))
    _through[2 * at(stop.face) + at(stop.end)] += stop.sign() * change;
  return change;
}

/// The nearest change by which all faces of the fan stay within their bounds.
double EquilibratedFlux::allowed(std::size_t fan, double best, FaceBounds bounds) const {
  double low = -infinite, high = infinite;
  for (const Stop& stop : stops(fan)) {
    const Face& face = _cut.faces[at(stop.face)];
    const std::size_t place = 2 * at(stop.face) + at(stop.end);
    double least = -infinite, most = infinite;
    if (face.condition == Condition::given) {
      least = most = face.traction < 0 || _balance.traction.empty()
                         ? 0
                         : _balance.traction[2 * at(face.traction) + at(stop.end)];
    } else if (presses(face.condition)) {
      most = _is_pressure ? 0 : bounds[place];
      if (!_is_pressure) least = -most;
    } else {
      continue;
    }
    const double now = _through[place];
    if (stop.end == 0) {  // w = -x
      low = std::max(low, now - most);
      high = std::min(high, now - least);
    } else {
      low = std::max(low, least - now);
      high = std::min(high, most - now);
    }
  }
  if (low > high) return 0.5 * (low + high);  // by rounding
  return std::clamp(best, low, high);
}

/// `flux` round the node, by its part in a triangle.
void EquilibratedFlux::rotate(const FanCorner& corner, double flux) {
  Vector& mean = _mean[at(corner.triangle)];
  const Vector old = mean;
  mean = {old[0] + flux * corner.edge[0], old[1] + flux * corner.edge[1]};
}

/// The fan of corner i adds to the flux through the sides j and k of its triangle x out and x' in,
/// where fans to come stand for half of T grad u. With a = x less half of T grad u through side j
/// this adds a e_i / (2 area) to the mean of sigma - T grad u, the load apart.
void EquilibratedFlux::build(const std::vector<double>& half, FaceBounds bounds) {
  _through.assign(2 * _cut.faces.size(), 0);
  const double* const force = _balance.force.empty() ? nullptr : _balance.force.data();
  std::vector<double> spokes(1), rotations;
  for (std::size_t fan = 0; fan < _cut.fan_count(); ++fan) {
    const std::span<const FanCorner> around = corners(fan);
    if (rotations.size() < around.size()) {
      rotations.resize(2 * around.size());
      spokes.resize(2 * around.size() + 1);
    }
    double* x = spokes.data();
    double* a = rotations.data();
    Vector slope{slope_of_work(fan), 0};
    for (const FanCorner& one : around) {
      const double out = *x + half[one.own()] - (force ? force[one.own()] : 0);
      *a = out + half[one.next()];
      Vector mean = _mean[at(one.triangle)];
      add(mean, *a, one.edge);
      add_product(slope, one, mean);
      *++x = out;
      ++a;
    }
    const std::span<const Stop> stops = this->stops(fan);
    if (stops.empty()) _imbalance = std::max(_imbalance, std::abs(*x));
    for (const Stop& stop : stops)
      _through[2 * at(stop.face) + at(stop.end)] = stop.sign() * spokes[at(stop.spoke)];
    const double change = step(fan, slope[0] + slope[1], bounds);
    a = rotations.data();
    for (const FanCorner& one : around) rotate(one, *a++ + change);
  }
}

void EquilibratedFlux::polish(FaceBounds bounds) {
  for (std::size_t fan = 0; fan < _cut.fan_count(); ++fan) {
    const std::span<const FanCorner> around = corners(fan);
    Vector slope{slope_of_work(fan), 0};
    for (const FanCorner& one : around) add_product(slope, one, _mean[at(one.triangle)]);
    const double change = step(fan, slope[0] + slope[1], bounds);
    for (const FanCorner& one : around) rotate(one, change);
  }
}

/// The moment of w_0, w_1 in the ends of a face less that of their even flux along it is
/// (w_0 - w_1)/2 (x_0 - x_1), that of kappa curl(l_0 l_1) is kappa/6 (x_0 - x_1). Where one face
/// may not be pulled the other takes both.
void EquilibratedFlux::turn() {
  const auto defect = [this](std::size_t face) {
    return 3 * (_through[2 * face] - _through[2 * face + 1]);
  };
  for (std::size_t f = 0; f < _cut.faces.size(); ++f) {
    const Face& face = _cut.faces[f];
    if (face.inclusion < 0 || _cut.tilts[at(face.inclusion)] == 0) continue;
    if (presses(face.condition)) continue;
    const auto other = at(face.other);
    const double taken = presses(_cut.faces[other].condition) ? defect(other) : 0;
    _turns.push_back({at(face.side), defect(f) - taken});
  }
  std::sort(_turns.begin(), _turns.end(),
            [](const Turn& a, const Turn& b) { return a.side < b.side; });
}

std::vector<EquilibratedFlux::Turn>::const_iterator EquilibratedFlux::first_turn(
    std::size_t triangle) const {
  return std::lower_bound(_turns.begin(), _turns.end(), 3 * triangle,
                          [](const Turn& turn, std::size_t side) { return turn.side < side; });
}

Vector EquilibratedFlux::mean_difference(std::size_t triangle) const {
  const double scale = 0.5 / _area[triangle];
  return {scale * _mean[triangle][0], scale * _mean[triangle][1]};
}

Vector EquilibratedFlux::difference(std::size_t triangle,
                                    const std::array<double, 3>& place) const {
  Vector result = mean_difference(triangle);
  for (std::size_t i = 3 * triangle; i < 3 * triangle + 3 && !_balance.force.empty(); ++i) {
    const std::size_t j = next(i), k = previous(i);
    const double rise = 4 * (_balance.force[k] - _balance.force[j]) / _area[triangle];
    add(result, rise * (place[j % 3] * place[k % 3] - 1.0 / 12), _edge[i]);
    // x - centroid = sum of l_i (P_i - centroid)
    const double sum = _balance.force[i] + _balance.force[j] + _balance.force[k];
    add(result, sum / _area[triangle] / 6 * place[i % 3], minus(_edge[k], _edge[j]));
  }
  for (auto one = first_turn(triangle); one != _turns.end() && one->side < 3 * triangle + 3;
       ++one) {
    // curl l_j of a corner is half its opposite edge over the area.
    const std::size_t j = next(one->side), k = previous(one->side);
    const double scale = one->kappa / (2 * _area[triangle]);
    add(result, scale * place[j % 3], _edge[k]);
    add(result, scale * place[k % 3], _edge[j]);
  }
  return result;
}

std::vector<double> EquilibratedFlux::distance() const {
  std::vector<double> distance(_mean.size());
  for (std::size_t t = 0; t < distance.size(); ++t) {
    const double rest = _rest.empty() ? 0 : _rest[t];
    distance[t] = _cut.shapes.compliance[t] * (dot(_mean[t], _mean[t]) + rest);
  }
  for (const Turn& one : _turns) {
    const std::size_t t = one.side / 3;
    double sum = 0;
    for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
      const double b = fem::rule_5.b[p], c = fem::rule_5.c[p];
      const Vector value = difference(t, {1 - b - c, b, c});
      sum += fem::rule_5.weight[p] * dot(value, value);
    }
    distance[t] = _area[t] * sum / _tension[t];
  }
  return distance;
}

std::vector<double> EquilibratedFlux::work_of_pressure() const {
  std::vector<double> work(_cut.faces.size(), 0);
  for (std::size_t face = 0; face < work.size(); ++face) {
    if (presses(_cut.faces[face].condition)) {
      work[face] =
          -0.5 * (_through[2 * face] + _through[2 * face + 1]) * (jump(face, 0) + jump(face, 1));
    }
  }
  return work;
}

Vector EquilibratedFlux::flux_of(std::size_t triangle, std::span<const double> values) const {
  const std::int32_t* copy = &_cut.copy[3 * triangle];
  const double first = values[at(copy[0])], scale = 2 * _cut.shapes.stiffness[triangle];
  Vector sum{};
  add(sum, values[at(copy[1])] - first, _edge[3 * triangle + 1]);
  add(sum, values[at(copy[2])] - first, _edge[3 * triangle + 2]);
  return {-scale * sum[1], scale * sum[0]};
}

double EquilibratedFlux::flux_through(std::size_t side, std::span<const double> values) const {
  return dot(flux_of(side / 3, values), normal_of(side));
}

Vector EquilibratedFlux::normal_of(std::size_t side) const { return normal(_edge[side]); }

bool EquilibratedFlux::turned(std::size_t triangle) const {
  const auto first = first_turn(triangle);
  return first != _turns.end() && first->side < 3 * triangle + 3;
}

}  // namespace anticrack::estimate
