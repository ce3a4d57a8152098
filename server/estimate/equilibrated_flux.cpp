// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/equilibrated_flux.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "base/large.hpp"
#include "estimate/flux_kernels.hpp"
#include "fem/triangle_rules.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1]}; }
void add(Vector& to, double factor, const Vector& what) {
  to[0] += factor * what[0];
  to[1] += factor * what[1];
}

constexpr std::size_t next(std::size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
constexpr std::size_t previous(std::size_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

void look() { stop::look("computing a flux in equilibrium"); }

FluxMesh flux_mesh(const CutMesh& cut) {
  std::int32_t largest = 0;
  for (std::size_t fan = 0; fan < cut.fan_count(); ++fan)
    largest = std::max(largest, cut.first_corner[fan + 1] - cut.first_corner[fan]);
  const Shapes& shapes = cut.shapes;
  return {at(largest),
          cut.copy.data(),
          cut.first_corner.data(),
          cut.first_stop.data(),
          shapes.edge.front().data(),
          shapes.tension.data(),
          shapes.softness.data(),
          shapes.around.data(),
          cut.met.data(),
          cut.met_until.data(),
          cut.stops.data(),
          cut.faces.data(),
          look};
}

/// The blocks with triangles, and last the fans between them.
std::vector<FluxBlock> blocks_of(const CutMesh& cut) {
  std::vector<FluxBlock> blocks(cut.block_count() + 1);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    blocks[b].first_triangle = cut.first_of_block(std::min(b, cut.block_count()));
    blocks[b].last_triangle = cut.first_of_block(std::min(b + 1, cut.block_count()));
    blocks[b].first_fan = at(cut.first_fan[b]);
    blocks[b].last_fan = at(cut.first_fan[b + 1]);
  }
  return blocks;
}

std::size_t largest_block(const std::vector<FluxBlock>& blocks) {
  std::size_t largest = 0;
  for (const FluxBlock& block : blocks)
    largest = std::max(largest, block.last_triangle - block.first_triangle);
  return largest;
}

}  // namespace

EquilibratedFlux::EquilibratedFlux(const Balance& balance, const CutMesh& cut, bool distances)
    : _cut(cut),
      _balance(balance),
      _tension(cut.shapes.tension),
      _area(cut.shapes.area),
      _edge(cut.shapes.edge),
      _distance(distances ? cut.triangle_count() : 0),
      _through(2 * cut.faces.size()) {}

EquilibratedFlux::EquilibratedFlux(const CutMesh& cut, const Balance& balance, FaceBounds bounds,
                                   int polish)
    : EquilibratedFlux(balance, cut, true) {
  make({this, 1}, {&bounds, 1}, polish);
}

std::vector<EquilibratedFlux> EquilibratedFlux::of_all(const CutMesh& cut,
                                                       std::span<const Balance> loads,
                                                       std::span<const FaceBounds> bounds,
                                                       int polish, bool distances) {
  std::vector<EquilibratedFlux> fluxes;
  fluxes.reserve(loads.size());
  for (const Balance& load : loads) {
    look();
    fluxes.push_back(EquilibratedFlux(load, cut, distances));
  }
  for (std::size_t done = 0; done < loads.size(); done += flux_lanes) {
    const std::size_t count = std::min(loads.size() - done, flux_lanes);
    make(std::span(fluxes).subspan(done, count),
         bounds.empty() ? bounds : bounds.subspan(done, count), polish);
  }
  return fluxes;
}

/// If loads are fewer than lanes, the last load fills the rest.
void EquilibratedFlux::make(std::span<EquilibratedFlux> fluxes, std::span<const FaceBounds> bounds,
                            int polish) {
  static const FluxKernels& kernels = *supported_flux_kernels(0);
  const CutMesh& cut = fluxes.front()._cut;
  const std::size_t lanes = fluxes.size() <= 2 ? fluxes.size() : flux_lanes;
  const FluxMesh mesh = flux_mesh(cut);
  std::array<FluxLane, flux_lanes> lane;
  std::array<const double*, flux_lanes> u;
  const auto values = [](std::span<const double> of) { return of.empty() ? nullptr : of.data(); };
  for (std::size_t l = 0; l < lanes; ++l) {
    const bool more = l < fluxes.size();
    EquilibratedFlux& own = fluxes[std::min(l, fluxes.size() - 1)];
    const Balance& load = own._balance;
    const FaceBounds of = bounds.empty() ? FaceBounds() : bounds[std::min(l, fluxes.size() - 1)];
    u[l] = load.u.data();
    lane[l] = {values(load.force), values(load.traction), values(of.least), values(of.most),
               more && !own._distance.empty() ? own._distance.data() : nullptr};
  }
  look();
  base::Large<double> side_by_side;
  if (lanes > 1) {
    side_by_side.resize(lanes * cut.at.size());
    constexpr std::size_t some = 65536;
    base::at_once((cut.at.size() + some - 1) / some, base::Threads::allowed(), [&] {
      return [&](std::size_t part) {
        const std::size_t end = std::min(cut.at.size(), (part + 1) * some);
        for (std::size_t i = part * some; i < end; ++i)
          for (std::size_t l = 0; l < lanes; ++l) side_by_side[lanes * i + l] = u[l][i];
      };
    });
  }
  std::vector<FluxBlock> blocks = blocks_of(cut);
  const std::size_t own_scratch = lanes * flux_scratch(mesh, largest_block(blocks));
  const auto means = std::make_shared<base::Large<double>>(lanes * 2 * cut.triangle_count());
  base::Large<double> through(lanes * 2 * cut.faces.size(), 0.0);
  const FluxLoop loop = lanes == 1 ? kernels.one : lanes == 2 ? kernels.two : kernels.several;
  const auto take = [&](FluxStep step) {
    const auto worker = [&] {
      return [&, own = base::Large<double>(own_scratch)](std::size_t b) mutable {
        loop(mesh, lane.data(), step, blocks[b],
             {lanes == 1 ? u.front() : side_by_side.data(), means->data(), through.data(),
              own.data()});
      };
    };
    base::at_once(blocks.size() - 1, base::Threads::allowed(), worker);
    worker()(blocks.size() - 1);
  };
  take(FluxStep::build);
  for (int sweep = 0; sweep < polish; ++sweep) take(FluxStep::polish);
  if (!fluxes.front()._distance.empty()) take(FluxStep::finish);
  for (std::size_t l = 0; l < fluxes.size(); ++l) {
    look();
    fluxes[l]._means = means;
    fluxes[l]._mean = means->data() + l;
    fluxes[l]._lanes = lanes;
    fluxes[l].finish(l, lanes, blocks, through);
  }
}

void EquilibratedFlux::finish(std::size_t lane, std::size_t lanes,
                              std::span<const FluxBlock> blocks, std::span<const double> through) {
  for (const FluxBlock& block : blocks) {
    _norm_squared += block.norm_squared[lane];
    _imbalance += block.imbalance[lane];
  }
  for (std::size_t place = 0; place < _through.size(); ++place)
    _through[place] = through[lanes * place + lane];
  turn();
}

double EquilibratedFlux::jump(std::size_t face, std::size_t end) const {
  const Face& own = _cut.faces[face];
  return _balance.u[at(_cut.ends(_cut.faces[at(own.other)])[1 - end])] -
         _balance.u[at(_cut.ends(own)[end])];
}

/// Fluxes w_0, w_1 at the ends of a face have the moment (w_0 - w_1)/2 (x_0 - x_1) more than their
/// sum spread evenly along it; kappa curl(l_0 l_1) has the moment kappa/6 (x_0 - x_1). If one face
/// may not be pulled, the other face takes both.
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
  for (const Turn& one : _turns) {
    if (_distance.empty()) break;
    const std::size_t t = one.side / 3;
    double sum = 0;
    for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
      const double b = fem::rule_5.b[p], c = fem::rule_5.c[p];
      const Vector value = difference(t, {1 - b - c, b, c});
      sum += fem::rule_5.weight[p] * dot(value, value);
    }
    _distance[t] = _area[t] * sum / _tension[t];
  }
}

std::vector<EquilibratedFlux::Turn>::const_iterator EquilibratedFlux::first_turn(
    std::size_t triangle) const {
  return std::lower_bound(_turns.begin(), _turns.end(), 3 * triangle,
                          [](const Turn& turn, std::size_t side) { return turn.side < side; });
}

Vector EquilibratedFlux::mean_difference(std::size_t triangle) const {
  const double scale = std::sqrt(_tension[triangle] / _area[triangle]);
  const Vector own = mean(triangle);
  return {scale * own[0], scale * own[1]};
}

Vector EquilibratedFlux::difference(std::size_t triangle,
                                    const std::array<double, 3>& place) const {
  Vector result = mean_difference(triangle);
  const auto side = [this](std::size_t corner) { return _cut.shapes.side(corner); };
  for (std::size_t i = 3 * triangle; i < 3 * triangle + 3 && !_balance.force.empty(); ++i) {
    const std::size_t j = next(i), k = previous(i);
    const double rise = 4 * (_balance.force[k] - _balance.force[j]) / _area[triangle];
    add(result, rise * (place[j % 3] * place[k % 3] - 1.0 / 12), side(i));
    // x - centroid = sum of l_i (P_i - centroid)
    const double sum = _balance.force[i] + _balance.force[j] + _balance.force[k];
    add(result, sum / _area[triangle] / 6 * place[i % 3], minus(side(k), side(j)));
  }
  for (auto one = first_turn(triangle); one != _turns.end() && one->side < 3 * triangle + 3;
       ++one) {
    // curl l_j of a corner is half the opposite edge over the area.
    const std::size_t j = next(one->side), k = previous(one->side);
    const double scale = one->kappa / (2 * _area[triangle]);
    add(result, scale * place[j % 3], side(k));
    add(result, scale * place[k % 3], side(j));
  }
  return result;
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
  const double scale = _tension[triangle] * std::sqrt(_tension[triangle] / _area[triangle]);
  const Vector rise = rise_of(triangle, values);
  return {-scale * rise[1], scale * rise[0]};
}

double EquilibratedFlux::flux_through(std::size_t side, std::span<const double> values) const {
  return dot(flux_of(side / 3, values), normal_of(side));
}

Vector EquilibratedFlux::normal_of(std::size_t side) const {
  const Vector along = _cut.shapes.side(side);
  return {along[1], -along[0]};
}

bool EquilibratedFlux::has_turn(std::size_t triangle) const {
  const auto first = first_turn(triangle);
  return first != _turns.end() && first->side < 3 * triangle + 3;
}

double largest_of(std::span<const double> values) {
  if (values.empty()) return 0;
  const auto size = static_cast<Eigen::Index>(values.size());
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), size).abs().maxCoeff();
}

double rest_of_forces(const CutMesh& cut, std::size_t triangle, const double* f, const double* g) {
  // The square of flux_loops.hpp, made bilinear.
  const double of_f = f[0] + f[1] + f[2], of_g = g[0] + g[1] + g[2];
  const auto change = [](const double* of, std::size_t i) {
    return of[(i + 2) % 3] - of[(i + 1) % 3];
  };
  double rest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double bubble = 2 * change(f, i) * change(g, i) -
                          0.5 * (change(f, j) * change(g, k) + change(f, k) * change(g, j)) -
                          of_f * of_g + 1.5 * (of_f * g[i] + of_g * f[i]);
    const Vector& edge = cut.shapes.edge[3 * triangle + i];
    rest += dot(edge, edge) * (of_f * of_g / 144 + bubble / 45);
  }
  return 4 * rest;
}

}  // namespace anticrack::estimate
