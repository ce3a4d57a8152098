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
  measure();
  build(bounds);
  centre();
  for (int sweep = 0; sweep < polish_sweeps; ++sweep) polish(bounds);
  turn();
}

/// Minus the outward flux of T grad u: through side i it is w_k (u_j - u_i) + w_j (u_k - u_i).
void EquilibratedFlux::measure() {
  const std::size_t count = _cut.triangle_count();
  _excess.resize(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    const std::int32_t* copy = &_cut.copy[3 * t];
    const std::array<double, 3>& weight = _cut.shapes.weight[t];
    const double u[3] = {_balance.u[at(copy[0])], _balance.u[at(copy[1])], _balance.u[at(copy[2])]};
    const double d[3] = {u[2] - u[1], u[0] - u[2], u[1] - u[0]};
    const double w[3] = {weight[0] * d[0], weight[1] * d[1], weight[2] * d[2]};
    for (std::size_t i = 0; i < 3; ++i) _excess[3 * t + i] = w[(i + 1) % 3] - w[(i + 2) % 3];
    _norm_squared += 0.5 * (w[0] * d[0] + w[1] * d[1] + w[2] * d[2]);
  }
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

void EquilibratedFlux::build(FaceBounds bounds) {
  _through.assign(2 * _cut.faces.size(), 0);
  const std::vector<double> target = _excess;  // minus the flux of T grad u
  const double* const force = _balance.force.empty() ? nullptr : _balance.force.data();
  std::vector<double> spokes(1);
  for (std::size_t fan = 0; fan < _cut.fan_count(); ++fan) {
    const std::span<const FanCorner> around = corners(fan);
    if (spokes.size() <= around.size()) spokes.resize(2 * around.size());
    double* x = spokes.data();  // through the spokes
    double slope = slope_of_work(fan);
    for (const FanCorner& one : around) {
      const double next = *x + 0.5 * target[at(one.i)] - (force ? force[one.i] : 0);
      slope += one.out * (next + 0.5 * target[at(one.j)]) + one.in * (0.5 * target[at(one.k)] - *x);
      *++x = next;
    }
    const std::span<const Stop> stops = this->stops(fan);
    if (stops.empty()) _imbalance = std::max(_imbalance, std::abs(*x));
    x = spokes.data();
    for (const Stop& stop : stops)
      _through[2 * at(stop.face) + at(stop.end)] = stop.sign() * x[stop.spoke];
    const double change = step(fan, slope, bounds);
    double* const excess = _excess.data();
    for (const FanCorner& one : around) {
      excess[one.k] -= *x + change;
      excess[one.j] += *++x + change;
    }
  }
}

/// On each triangle sigma - T grad u is its mean, d/2 (x - centroid) with the divergence d, and the
/// bubble  b = 1/3 sum_(i<j) (f_j - f_i)(P_j - P_i) l_i l_j  less its mean: div b = -(f - mean f),
/// and no flux through the sides.
void EquilibratedFlux::centre() {
  const std::size_t count = _cut.triangle_count();
  _centre.assign(count, Vector{});
  _rest.assign(count, 0.0);
  for (std::size_t t = 0; t < count; ++t) {
    const Vector* edge = &_edge[3 * t];
    const double* excess = &_excess[3 * t];
    const double one_over = 1 / _area[t];
    for (std::size_t i = 0; i < 3; ++i)
      add(_centre[t], one_over / 6 * excess[i], minus(edge[(i + 2) % 3], edge[(i + 1) % 3]));
    if (_balance.force.empty()) continue;
    const double* force = &_balance.force[3 * t];
    const double divergence = -(force[0] + force[1] + force[2]) * one_over;
    const double lengths = dot(edge[0], edge[0]) + dot(edge[1], edge[1]) + dot(edge[2], edge[2]);
    _rest[t] = divergence * divergence * _area[t] * lengths / 144;
    if (force[0] == force[1] && force[1] == force[2]) continue;
    // Along the edge opposite to corner i, from j to k, f grows by 12 / area times the loads.
    std::array<Vector, 3> along{};
    Vector sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      add(along[i], 4 * (force[k] - force[j]) * one_over, edge[i]);  // a third of it
      add(sum, 1, along[i]);
    }
    add(_centre[t], 1.0 / 12, sum);
    double squares = 0, products = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      squares += dot(along[i], along[i]);
      products += dot(along[i], along[j]);
      // P_j + P_k - 2 P_i
      _rest[t] += divergence * _area[t] / 180 * dot(along[i], minus(edge[k], edge[j]));
    }
    _rest[t] += _area[t] * ((squares + products) / 90 - dot(sum, sum) / 144);
  }
}

void EquilibratedFlux::polish(FaceBounds bounds) {
  Vector* const centre = _centre.data();
  for (std::size_t fan = 0; fan < _cut.fan_count(); ++fan) {
    const std::span<const FanCorner> around = corners(fan);
    double slope = slope_of_work(fan);
    for (const FanCorner& one : around) slope += dot(centre[one.triangle], one.slope);
    const double change = step(fan, slope, bounds);
    for (const FanCorner& one : around)
      add(centre[one.triangle], change * one.compliance, one.slope);
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

Vector EquilibratedFlux::difference(std::size_t triangle,
                                    const std::array<double, 3>& place) const {
  Vector result = _centre[triangle];
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
  std::vector<double> distance(_centre.size());
  for (std::size_t t = 0; t < distance.size(); ++t)
    distance[t] = (_area[t] * dot(_centre[t], _centre[t]) + _rest[t]) / _tension[t];
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
  Vector flux{};
  for (std::size_t i = 3 * triangle; i < 3 * triangle + 3; ++i) {
    add(flux, -_tension[triangle] * values[at(_cut.copy[i])] / (2 * _area[triangle]), normal_of(i));
  }
  return flux;
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
