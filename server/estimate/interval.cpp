// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/interval.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "estimate/bracket.hpp"
#include "estimate/flux_kernels.hpp"
#include "fem/triangle_rules.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

double largest_of(std::span<const double> values) {
  double largest = 0;
  for (const double one : values) largest = std::max(largest, std::abs(one));
  return largest;
}

/// How far jumps or pressures leave the cone: values up to `rounding` count as 0, and `beyond` may
/// be at most `most`.
struct Cone {
  double rounding = 0, most = 0, beyond = 0;
  double all_beyond = 0;  ///< sum over all
  bool left() const { return beyond > most; }
  /// The part of a number within `bound`; 0 if it is rounding.
  double kept(double of, double bound) const {
    return std::abs(of) <= rounding ? 0 : std::clamp(of, -bound, bound);
  }
};

/// Integrals of products over T: of tau - T grad z with itself (`square`) and with sigma - T grad
/// u_h (`mixed`), and of the latter with itself (`distance`). If T varies on triangles they are
/// bounds, and `slack` bounds the error of `mixed`.
struct Products {
  double square = 0;
  double mixed = 0;
  double distance = 0;
  double slack = 0;

  void operator+=(const Products& by) {
    square += by.square;
    mixed += by.mixed;
    distance += by.distance;
    slack += by.slack;
  }
};

/// The products of a triangle from those with T_h, as in bracket.hpp. |1/T - 1/T_h| T_h <=
/// `change`.
Products varied(const Products& by_mean, const fem::Variation& variation, double norm_of_z,
                double norm_of_u) {
  const double a = variation.below * std::sqrt(by_mean.square), b = variation.spread * norm_of_z,
               c = variation.below * std::sqrt(by_mean.distance), d = variation.spread * norm_of_u;
  const double change =
      std::max(variation.below * variation.below - 1, 1 - 1 / (variation.above * variation.above));
  return {(a + b) * (a + b), by_mean.mixed, (c + d) * (c + d),
          change * std::sqrt(by_mean.square * by_mean.distance) + a * d + b * (c + d) +
              2 * variation.unknown * norm_of_z * norm_of_u};
}

class Sum {
 public:
  Sum(const Primal& primal, const Dual& dual, const EquilibratedFlux& tau)
      : _primal(primal), _tau(tau), _z(dual.z), _rest(dual.z.size()) {
    for (std::size_t i = 0; i < _rest.size(); ++i) _rest[i] = dual.reacting[i] - dual.z[i];
  }

  Products products() const {
    Products sum;
    const EquilibratedFlux& sigma = _primal.flux;
    const Shapes& shapes = _primal.cut.shapes;
    for (std::size_t t = 0; t < _primal.cut.triangle_count(); ++t) {
      stop::look_at_turn(t, "computing bounds of A");
      const Products own = of_triangle(t);
      if (shapes.variation.empty())
        sum += own;
      else
        sum += varied(own, shapes.variation[t], std::sqrt(sigma.energy_of(t, _z)),
                      std::sqrt(sigma.energy_of(t, _primal.u)));
    }
    return sum;
  }

  /// int (tau - T grad z) . grad w divided by int phi, with the mean of tau - T grad z if that is
  /// not constant. w is 0 but at the outer boundary.
  double lifted(const Lift& lift) const {
    const auto side = at(_primal.cut.faces[at(lift.face)].side);
    const Vector normal = _primal.flux.normal_of(side), mean = _tau.mean_difference(side / 3),
                 shift = _primal.flux.flux_of(side / 3, _rest);
    return (mean[0] + shift[0]) * normal[0] + (mean[1] + shift[1]) * normal[1];
  }

 private:
  Products of_triangle(std::size_t t) const {
    const EquilibratedFlux& sigma = _primal.flux;
    const Shapes& shapes = _primal.cut.shapes;
    Products sum;
    sum.distance = std::max(0.0, sigma.distance()[t]);
    const auto add = [&](double factor, const Vector& off, const Vector& of_sigma) {
      sum.square += factor * dot(off, off);
      sum.mixed += factor * dot(off, of_sigma);
    };
    if (!_tau.turned(t)) {  // constant: sqrt(area / T) times both
      const Vector &of_tau = _tau.mean(t), rise = sigma.rise_of(t, _rest);
      const double tension = shapes.tension[t];
      add(1, {of_tau[0] - tension * rise[1], of_tau[1] + tension * rise[0]}, sigma.mean(t));
      return sum;
    }
    const Vector shift = sigma.flux_of(t, _rest);
    const double scale = sigma.area(t) / sigma.tension(t);
    for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
      const double b = fem::rule_5.b[p], c = fem::rule_5.c[p];
      const Vector of_tau = _tau.difference(t, {1 - b - c, b, c});
      add(scale * fem::rule_5.weight[p], {of_tau[0] + shift[0], of_tau[1] + shift[1]},
          sigma.difference(t, {1 - b - c, b, c}));
    }
    return sum;
  }

  const Primal& _primal;
  const EquilibratedFlux& _tau;
  std::span<const double> _z;
  std::vector<double> _rest;
};

/// The bounds c p of |q|; 0 if p < 0 by rounding.
std::vector<double> cone_of(const EquilibratedFlux& sigma, double c) {
  std::vector<double> bounds = sigma.through_faces();
  for (double& bound : bounds) bound = c * std::max(0.0, -bound);
  return bounds;
}

Interval interval(const Aimed& aimed, const EquilibratedFlux& tau) {
  const Primal& primal = *aimed.primal;
  const Dual& dual = aimed.dual;
  const CutMesh& cut = primal.cut;
  const EquilibratedFlux& sigma = primal.flux;
  if (!cut.shapes.variation.empty() && !primal.lifts.empty()) return {};

  double pressure = 0;
  for (const double one : sigma.work_of_pressure()) pressure += std::max(0.0, one);
  const Sum sum(primal, dual, tau);
  const Products products = sum.products();
  double residual = 0, mixed = 0.5 * products.mixed, distance = products.distance, unknown = 0;
  for (const Lift& lift : primal.lifts) {
    const auto side = at(cut.faces[at(lift.face)].side);
    const double through = sigma.flux_through(side, dual.z), lifted = sum.lifted(lift);
    residual -= lift.mean * through;
    mixed -= 0.5 * lift.mean * lifted;
    unknown += lift.unknown * (std::abs(through) + 0.5 * std::abs(lifted));
    const LiftIntegrals of = integrals_of(cut, sigma, primal.load, lift, primal.u);
    distance += of.norm * of.norm - 2 * of.difference() + 2 * of.unknown;
  }

  double above = 0, below = 0, work = 0;
  // Fluxes are sums of T grad z', whose rounding errors are relative to T |z'|.
  const double of_jumps = 1e-12 * largest_of(dual.z),
               of_pressures = 1e-12 * largest_of(tau.through_faces()) +
                              1e-13 * cut.shapes.largest_tension * largest_of(dual.reacting);
  // Conjugate gradients leave more than rounding errors in z'; Ways lead them out of the membrane.
  const bool bridged = std::isfinite(cut.ways.triangle);
  std::vector<double> kept(cut.faces.size(), 0);
  Cone jumps{of_jumps, of_jumps}, pressures{of_pressures, 1000 * of_pressures};
  const auto limit = [&](Cone& cone, double of_dual, double of_primal) {
    const double most = dual.c * std::max(0.0, of_primal), size = std::abs(of_dual);
    if (size <= cone.rounding) {  // counts as 0, as its sign means nothing
      cone.all_beyond += size;
      return;
    }
    cone.beyond = std::max(cone.beyond, size - most);
    cone.all_beyond += std::max(0.0, size - most);
    double& c = of_dual > 0 ? above : below;
    c = std::max(c, size < most ? size / of_primal : dual.c);
  };
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    const Face& face = cut.faces[f];
    if (face.traction >= 0 && !primal.load.traction.empty()) {
      const double* load = &primal.load.traction[2 * at(face.traction)];
      const auto ends = cut.ends(face);
      residual -= 0.5 * (load[0] - load[1]) * (dual.z[at(ends[0])] - dual.z[at(ends[1])]);
    }
    if (!presses(face.condition)) continue;
    const auto ends = cut.ends(face), others = cut.ends(cut.faces[at(face.other)]);
    for (const std::size_t end : {0, 1})
      limit(jumps, dual.z[at(others[1 - end])] - dual.z[at(ends[end])], sigma.jump(f, end));
    const auto through = [&](const EquilibratedFlux& flux) {
      return flux.through_faces()[2 * f] + flux.through_faces()[2 * f + 1];
    };
    const double outward = through(tau), pressure_of = std::max(0.0, -through(sigma));  // -q, p
    kept[f] = bridged ? pressures.kept(outward, dual.c * pressure_of) : outward;
    work -= 0.5 * kept[f] * (sigma.jump(f, 0) + sigma.jump(f, 1));
    limit(pressures, outward, pressure_of);
  }
  if (jumps.left() || pressures.left()) return {};  // no bounds: another c is better
  double beyond = 0;
  for (const double one : primal.load.oscillation) beyond += one * one;
  const double off = std::sqrt(std::max(0.0, distance)), of_dual = std::sqrt(products.square);
  const double s = bridged ? primal.lack.flux : 0;
  const double t = bridged ? lack_of(cut, tau, {}, dual.unit, kept).flux : 0;
  const double rho = std::sqrt((off + s) * (off + s) / 4 + pressure), eta = of_dual + t;
  const double middle = dual.value + work + residual + mixed;
  const double lacking =
      bridged ? primal.lack.work * largest_of(dual.z) + 0.5 * (of_dual * s + t * off + s * t)
              : 2 * largest_of(primal.u) * pressures.all_beyond;
  const double extra = aimed.unloaded * std::sqrt(beyond) + 0.5 * products.slack + unknown +
                       1e-12 * (std::abs(dual.value) + std::abs(middle)) + lacking;
  return {middle - half_width(below, eta, rho) - extra,
          middle + half_width(above, eta, rho) + extra,
          mixed,
          eta / (2 * dual.c * rho),
          middle,
          eta,
          rho,
          below,
          above};
}

double norm(const CutMesh& cut, const EquilibratedFlux& tau, std::span<const ForceOn> unit) {
  const std::vector<double> nothing(cut.faces.size(), 0);
  const double lack = lack_of(cut, tau, {}, unit, nothing).flux;
  double distance = 0;
  for (const double one : tau.distance()) distance += std::max(0.0, one);
  double below = 1;
  for (const fem::Variation& one : cut.shapes.variation) below = std::max(below, one.below);
  return below * (std::sqrt(tau.norm_squared()) + std::sqrt(distance)) +
         (std::isfinite(lack) ? lack : 0);
}

}  // namespace

double half_width(double c, double eta, double rho) {
  return 2 * c * rho <= eta ? eta * rho : c * rho * rho + eta * eta / (4 * c);
}

EquilibratedFlux dual_flux(const CutMesh& cut, const EquilibratedFlux& sigma, const Dual& dual) {
  return EquilibratedFlux(cut, {dual.reacting, {}, {}}, cone_of(sigma, dual.c));
}

std::vector<Interval> intervals(const CutMesh& cut, std::span<const Aimed> of) {
  std::vector<std::vector<double>> cones;
  std::vector<Balance> balances;
  for (const Aimed& one : of) {
    cones.push_back(cone_of(one.primal->flux, one.dual.c));
    balances.push_back({one.dual.reacting, {}, {}});
  }
  const std::vector<FaceBounds> bounds(cones.begin(), cones.end());
  const std::vector<EquilibratedFlux> taus = EquilibratedFlux::of_all(cut, balances, bounds);
  std::vector<Interval> found;
  for (std::size_t i = 0; i < of.size(); ++i) found.push_back(interval(of[i], taus[i]));
  return found;
}

Interval interval(const Primal& primal, const Dual& dual, double unloaded) {
  const Aimed one{&primal, dual, unloaded};
  return intervals(primal.cut, {&one, 1}).front();
}

std::vector<double> norms_of_fluxes(const CutMesh& cut,
                                    std::span<const std::vector<double>> reacting,
                                    std::span<const std::vector<ForceOn>> units) {
  const std::vector<double> none(2 * cut.faces.size(), 0.0);
  const std::vector<FaceBounds> bounds(flux_lanes, none);
  std::vector<double> norms;
  while (!reacting.empty()) {
    const auto some = reacting.first(std::min(flux_lanes, reacting.size()));
    std::vector<Balance> balances;
    for (const std::vector<double>& one : some)
      if (!one.empty()) balances.push_back({one, {}, {}});
    const std::vector<EquilibratedFlux> taus = EquilibratedFlux::of_all(cut, balances, bounds);
    auto tau = taus.begin();
    for (std::size_t i = 0; i < some.size(); ++i)
      norms.push_back(some[i].empty() ? std::numeric_limits<double>::infinity()
                                      : norm(cut, *tau++, units[i]));
    reacting = reacting.subspan(some.size());
    units = units.subspan(some.size());
  }
  return norms;
}

}  // namespace anticrack::estimate
