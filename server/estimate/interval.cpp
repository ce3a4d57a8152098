// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/interval.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "base/large.hpp"
#include "estimate/bracket.hpp"
#include "fem/triangle_rules.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

/// How far jumps or pressures leave the cone: values up to `rounding` count as 0, and `beyond` may
/// be at most `most`.
struct Cone {
  double rounding = 0, most = 0, beyond = 0;
  double all_beyond = 0;  ///< sum over all
  bool left() const { return beyond > most; }
  /// The part of a number within `bound` on the side of `sign`; 0 if it is rounding.
  double kept(double of, double sign, double bound) const {
    return std::abs(of) <= rounding ? 0 : sign * std::min(sign * of, bound);
  }
};

/// Sums over the triangles with an unbalanced load.
struct Rest : Unbalanced {
  double moved = 0;    ///< >= int (f - f_h) z + int (g - g_h) z
  double weighed = 0;  ///< o^2 where there is a weight, which the others leave out

  void operator+=(const Rest& by) {
    squared += by.squared;
    primal += by.primal;
    dual += by.dual;
    moved += by.moved;
    weighed += by.weighed;
  }
};

/// Integrals of products over T: of tau - T grad z with itself (`square`) and with sigma - T grad
/// u_h (`mixed`), and of the latter with itself (`distance`). If T varies on triangles they are
/// bounds, and `slack` bounds the error of `mixed`.
struct Integrals {
  double square = 0;
  double mixed = 0;
  double distance = 0;
  double slack = 0;

  void operator+=(const Integrals& by) {
    square += by.square;
    mixed += by.mixed;
    distance += by.distance;
    slack += by.slack;
  }
};

struct Products : Integrals {
  Rest rest{};
  std::array<PartTerms, 2> parts{};

  using Integrals::operator+=;
  void operator+=(const Products& by) {
    *this += static_cast<const Integrals&>(by);
    rest += by.rest;
    for (const std::size_t p : {0, 1}) {
      parts[p].distance += by.parts[p].distance;
      parts[p].square += by.parts[p].square;
      parts[p].unbalanced.squared += by.parts[p].unbalanced.squared;
      parts[p].unbalanced.primal += by.parts[p].unbalanced.primal;
    }
  }
};

/// Triangles whose products are summed together, small enough for several duals to find in the
/// cache what they share.
constexpr std::size_t some_triangles = 4096;

/// The products of a triangle from those with T_h, as in bracket.hpp. |1/T - 1/T_h| T_h <=
/// `change`.
Integrals varied(const Integrals& by_mean, const fem::Variation& variation, double norm_of_z,
                 double norm_of_u) {
  const double a = variation.below * std::sqrt(by_mean.square), b = variation.spread * norm_of_z,
               c = variation.below * std::sqrt(by_mean.distance), d = variation.spread * norm_of_u;
  const double change =
      std::max(variation.below * variation.below - 1, 1 - 1 / (variation.above * variation.above));
  return {(a + b) * (a + b), by_mean.mixed, (c + d) * (c + d),
          change * std::sqrt(by_mean.square * by_mean.distance) + a * d + b * (c + d) +
              2 * variation.unknown * norm_of_z * norm_of_u};
}

/// (m) The parts of the triangles in E and F; empty if nobody asks for them.
struct Parts {
  std::vector<double> primal, dual;
};

class Sum {
 public:
  Sum(const Primal& primal, const Dual& dual, const EquilibratedFlux& tau)
      : _primal(primal), _tau(tau), _weight(dual.weight), _z(dual.z) {
    if (dual.reacting.data() == dual.z.data()) return;
    _rest.resize(_z.size());
    std::ranges::transform(dual.reacting, _z, _rest.begin(), std::minus());
  }

  /// The products of `some_triangles`, from a multiple of it on, whose parts it sets.
  Products products(std::size_t first, Parts& parts) const {
    Products sum;
    const EquilibratedFlux& sigma = _primal.flux;
    const Shapes& shapes = _primal.cut.shapes;
    const std::vector<double>& oscillation = _primal.load.oscillation;
    std::span<const Weight::OnTriangle> weighed;
    if (_weight != nullptr) {
      const auto begin =
          std::ranges::lower_bound(_weight->triangles, first, {}, &Weight::OnTriangle::triangle);
      weighed = {begin, _weight->triangles.end()};
    }
    const std::size_t last = std::min(first + some_triangles, _primal.cut.triangle_count());
    for (std::size_t t = first; t < last; ++t) {
      Integrals own = of_triangle(t);
      if (!shapes.variation.empty())
        own = varied(own, shapes.variation[t], std::sqrt(sigma.energy_of(t, _z)),
                     std::sqrt(sigma.energy_of(t, _primal.u)));
      sum += own;
      PartTerms& part = sum.parts[part_of(t)];
      part.distance += own.distance;
      part.square += own.square;
      const bool inside = !weighed.empty() && weighed.front().triangle == t;
      if (!parts.primal.empty()) {
        const double o = oscillation.empty() ? 0 : oscillation[t],
                     e = (std::sqrt(own.distance) + o) / 2, f = own.square / 4;
        parts.primal[t] = e * e * (inside ? primal_factor(weighed.front()) : 1);
        parts.dual[t] = f * (inside ? dual_factor(weighed.front()) : 1);
      }
      if (inside) weighed = weighed.subspan(1);
      if (oscillation.empty() || oscillation[t] == 0) continue;
      const double o = oscillation[t];
      Rest& of = sum.rest;
      if (inside) {
        of.weighed += o * o;
        continue;
      }
      for (Unbalanced* all : {static_cast<Unbalanced*>(&of), &part.unbalanced}) {
        all->squared += o * o;
        all->primal += o * std::sqrt(own.distance);
      }
      of.dual += o * std::sqrt(own.square);
      const std::int32_t* copy = &_primal.cut.copy[3 * t];
      const double largest = std::max(
          {std::abs(_z[at(copy[0])]), std::abs(_z[at(copy[1])]), std::abs(_z[at(copy[2])])});
      of.moved += std::min(o * std::sqrt(sigma.energy_of(t, _z)),
                           largest > 0 ? _primal.load.moments[t] * largest : 0);
    }
    return sum;
  }

  /// Index into Terms::parts.
  std::size_t part_of(std::size_t t) const {
    return _primal.stiff != nullptr && _primal.stiff->has[t] != 0 ? 1 : 0;
  }

  /// int (tau - T grad z) . grad w divided by int phi, with the mean of tau - T grad z if that is
  /// not constant. w is 0 but at the outer boundary.
  double lifted(const Lift& lift) const {
    const auto side = at(_primal.cut.faces[at(lift.face)].side);
    const Vector normal = _primal.flux.normal_of(side), mean = _tau.mean_difference(side / 3),
                 shift = shift_of(side / 3);
    return (mean[0] + shift[0]) * normal[0] + (mean[1] + shift[1]) * normal[1];
  }

  /// b = beta w where w is not constant, so that w + b + b^2/h = w / (1 - beta).
  Weighted weighted() const {
    Weighted sum;
    if (_weight == nullptr) return sum;
    for (const Weight::OnTriangle& one : _weight->triangles) {
      const Integrals own = of_triangle(one.triangle);
      const double beta = beta_in(one);
      sum.primal += (primal_factor(one) - 1) * own.distance;
      sum.dual += (dual_factor(one) - 1) * own.square;
      sum.mixed += beta / (1 - beta) * std::sqrt(own.square * own.distance);
    }
    sum.most_primal = _weight->largest / (1 - _weight->beta);
    sum.most_mixed = _weight->beta / (1 - _weight->beta);
    sum.most_dual = 1 / (1 - _weight->beta);
    return sum;
  }

 private:
  /// T grad (z' - z).
  Vector shift_of(std::size_t t) const {
    return _rest.empty() ? Vector{} : _primal.flux.flux_of(t, _rest);
  }

  Integrals of_triangle(std::size_t t) const {
    const EquilibratedFlux& sigma = _primal.flux;
    Integrals sum;
    sum.distance = std::max(0.0, sigma.distance()[t]);
    const auto add = [&](double factor, const Vector& off, const Vector& of_sigma) {
      sum.square += factor * dot(off, off);
      sum.mixed += factor * dot(off, of_sigma);
    };
    if (!_tau.turned(t)) {  // constant: sqrt(area / T) times both
      Vector off = _tau.mean(t);
      if (!_rest.empty()) {
        const Vector rise = sigma.rise_of(t, _rest);
        const double tension = sigma.tension(t);
        off = {off[0] - tension * rise[1], off[1] + tension * rise[0]};
      }
      add(1, off, sigma.mean(t));
      return sum;
    }
    const Vector shift = shift_of(t);
    const double scale = sigma.area(t) / sigma.tension(t);
    for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
      const double b = fem::rule_5.b[p], c = fem::rule_5.c[p];
      const Vector of_tau = _tau.difference(t, {1 - b - c, b, c});
      add(scale * fem::rule_5.weight[p], {of_tau[0] + shift[0], of_tau[1] + shift[1]},
          sigma.difference(t, {1 - b - c, b, c}));
    }
    return sum;
  }

  double beta_in(const Weight::OnTriangle& one) const { return one.sloped ? _weight->beta : 0; }
  double primal_factor(const Weight::OnTriangle& one) const {
    return one.most / (1 - beta_in(one));
  }
  double dual_factor(const Weight::OnTriangle& one) const {
    return 1 / ((1 - beta_in(one)) * one.least);
  }

  const Primal& _primal;
  const EquilibratedFlux& _tau;
  const Weight* _weight;
  std::span<const double> _z;
  base::Large<double> _rest;  // z' - z
};

/// The bounds of tau.n on minus faces, which is -q.
struct FluxBounds {
  std::vector<double> least, most;
  operator FaceBounds() const { return {least, most}; }
};

/// What q has on the other side of 0 costs int q [v] in the middle. It needs no bound, but gets
/// one but for closed nodes, whose reaction it has to carry. Where cracks cross, a jump of rounding
/// is one of 0.
FluxBounds flux_bounds(const Primal& primal, const Dual& dual) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  const CutMesh& cut = primal.cut;
  const EquilibratedFlux& sigma = primal.flux;
  const double rounding = 1e-13 * primal.largest;
  FluxBounds bounds{std::vector<double>(2 * cut.faces.size()),
                    std::vector<double>(2 * cut.faces.size())};
  WeightOf weights(sigma, dual.weight);
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    if (!presses(cut.faces[f].condition)) continue;
    const Weight::OnFace on = weights.on(f);
    const auto ends = cut.ends(cut.faces[f]), others = cut.ends(cut.faces[at(cut.faces[f].other)]);
    for (const std::size_t end : {0, 1}) {
      const bool tip = ends[end] == others[1 - end],
                 closed = !tip && !(sigma.jump(f, end) > rounding);
      const double bound = dual.c_on(primal, f) * on.bound[end], other = closed ? unlimited : bound;
      const bool upper = dual.side == Side::upper;
      bounds.most[2 * f + end] = upper ? bound : other;
      bounds.least[2 * f + end] = -(upper ? other : bound);
    }
  }
  return bounds;
}

/// A Weight needs both T constant and w = 0.
bool weighable(const Aimed& aimed) {
  const Primal& primal = *aimed.primal;
  return aimed.dual.weight == nullptr ||
         (primal.cut.shapes.variation.empty() && primal.lifts.empty());
}

/// The bound made of what was summed over the triangles.
Bound bound(const Aimed& aimed, const EquilibratedFlux& tau, const Sum& sum,
            const Products& products, Parts parts) {
  const Primal& primal = *aimed.primal;
  const Dual& dual = aimed.dual;
  const CutMesh& cut = primal.cut;
  const EquilibratedFlux& sigma = primal.flux;
  const bool varies = !cut.shapes.variation.empty();
  double residual = 0, mixed = 0.5 * products.mixed, distance = products.distance, unknown = 0,
         of_lifts = 0;
  std::array<PartTerms, 2> parts_of = products.parts;
  std::array<double, 2> lifts_of{};
  for (const Lift& lift : primal.lifts) {
    const auto side = at(cut.faces[at(lift.face)].side);
    const double through = sigma.flux_through(side, dual.z), lifted = sum.lifted(lift);
    residual -= lift.mean * through;
    mixed -= 0.5 * lift.mean * lifted;
    unknown += lift.unknown * (std::abs(through) + 0.5 * std::abs(lifted));
    const LiftIntegrals of = integrals_of(cut, sigma, primal.load, lift, primal.u);
    if (!varies) {
      const double more = of.norm * of.norm - 2 * of.difference() + 2 * of.unknown;
      distance += more;
      parts_of[sum.part_of(side / 3)].distance += more;
      continue;
    }
    const fem::Variation& variation = cut.shapes.variation[side / 3];
    const double norm = variation.above * of.norm;
    of_lifts += 3 * norm * norm;  // a triangle has no more sides
    lifts_of[sum.part_of(side / 3)] += 3 * norm * norm;
    unknown += 1.5 * (variation.spread + variation.unknown) * norm *
               std::sqrt(sigma.energy_of(side / 3, dual.z));
  }
  if (of_lifts > 0) distance = std::pow(std::sqrt(distance) + std::sqrt(of_lifts), 2);
  for (std::size_t p : {0, 1}) {
    double& own = parts_of[p].distance;
    own = std::max(0.0, own);
    if (lifts_of[p] > 0) own = std::pow(std::sqrt(own) + std::sqrt(lifts_of[p]), 2);
    if (!primal.lifts.empty())
      parts_of[p].unbalanced.primal = std::sqrt(own * parts_of[p].unbalanced.squared);
  }

  const double sign = dual.side == Side::upper ? 1 : -1;
  double c = 0, work = 0, pressure = 0;  // c as of Dual
  // Fluxes are sums of T grad z', whose rounding errors are relative to T |z'|.
  const bool one_field = dual.z.data() == dual.reacting.data();
  const double largest_z = largest_of(dual.z),
               largest_reacting = one_field ? largest_z : largest_of(dual.reacting);
  const double of_jumps = 1e-12 * largest_z,
               of_pressures = 1e-12 * largest_of(tau.through_faces()) +
                              1e-13 * cut.shapes.largest_tension * largest_reacting;
  // Conjugate gradients leave more than rounding errors in z'; Ways lead them out of the membrane.
  const bool bridged = std::isfinite(cut.ways.triangle);
  std::vector<double> kept(cut.faces.size(), 0);
  Cone jumps{of_jumps, of_jumps}, pressures{of_pressures, 1000 * of_pressures};
  // What is on the other side of 0 may be of any size.
  const auto limit = [&](Cone& cone, double of_dual, double of_primal, std::size_t face,
                         PartTerms& part) {
    const double c_there = dual.c_on(primal, face), most = c_there * std::max(0.0, of_primal),
                 size = std::abs(of_dual);
    if (size <= cone.rounding) {  // counts as 0, as its sign means nothing
      cone.all_beyond += size;
      return;
    }
    if (sign * of_dual < 0) return;
    cone.beyond = std::max(cone.beyond, size - most);
    cone.all_beyond += std::max(0.0, size - most);
    part.c = std::max(part.c, size < most ? size / of_primal : c_there);
    c = std::max(c, size < most ? size / of_primal * (dual.c / c_there) : dual.c);
  };
  WeightOf weights(sigma, dual.weight);
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    const Face& face = cut.faces[f];
    if (face.traction >= 0 && !primal.load.traction.empty()) {
      const double* load = &primal.load.traction[2 * at(face.traction)];
      const auto ends = cut.ends(face);
      residual -= 0.5 * (load[0] - load[1]) * (dual.z[at(ends[0])] - dual.z[at(ends[1])]);
    }
    if (!presses(face.condition)) continue;
    const Weight::OnFace on = weights.on(f);
    const auto ends = cut.ends(face), others = cut.ends(cut.faces[at(face.other)]);
    PartTerms& part =
        parts_of[primal.stiff != nullptr && primal.stiff->has_face(cut, face) ? 1 : 0];
    for (const std::size_t end : {0, 1}) {
      const double of_z = dual.z[at(others[1 - end])] - dual.z[at(ends[end])];
      residual += sigma.through_faces()[2 * f + end] * of_z;
      limit(jumps, of_z, on.least * sigma.jump(f, end), f, part);
    }
    const auto through = [&](const EquilibratedFlux& flux) {
      return flux.through_faces()[2 * f] + flux.through_faces()[2 * f + 1];
    };
    const double outward = through(tau), bound = std::max(0.0, on.bound[0] + on.bound[1]);
    kept[f] =
        bridged ? pressures.kept(outward, sign, dual.c_on(primal, f) * bound) : outward;  // -q
    const double opening = sigma.jump(f, 0) + sigma.jump(f, 1);
    work -= 0.5 * kept[f] * opening;
    const double own = on.most * std::max(0.0, -0.5 * through(sigma) * opening);
    pressure += own;
    part.pressure += own;
    limit(pressures, outward, bound, f, part);
  }
  if (jumps.left() || pressures.left()) return {};  // no bounds: another c is better
  const Rest& rest = products.rest;
  Terms terms{dual.value,
              work,
              residual,
              mixed,
              distance,
              products.square,
              pressure,
              bridged ? primal.lack.flux : 0,
              bridged ? lack_of(cut, tau, {}, dual.unit, kept).flux : 0,
              rest};
  if (!primal.lifts.empty())
    terms.unbalanced.primal = std::sqrt(std::max(0.0, distance) * rest.squared);
  terms.weighted = sum.weighted();
  if (primal.stiff != nullptr && dual.weight == nullptr) {
    terms.parts = parts_of;
    terms.coupling = primal.stiff->coupling;
  }
  terms.extra =
      aimed.unloaded * std::sqrt(rest.weighed) + rest.moved + 0.5 * products.slack + unknown +
      (bridged ? primal.lack.work * largest_z : 2 * primal.largest * pressures.all_beyond);
  Bound found = bound_of(terms, dual.side, c, dual.c);
  if (const double best = found.half.best(c); std::isfinite(best)) {
    found.parts = std::move(parts.primal);
    for (std::size_t k = 0; k < found.parts.size(); ++k) {
      const double own = sum.part_of(k) == 1 ? best * found.stiff : best;
      found.parts[k] = own * found.parts[k] + parts.dual[k] / own;
    }
  }
  return found;
}

/// Several bounds by taus of the same number.
std::vector<Bound> bounds_by(std::span<const Aimed> of, std::span<const EquilibratedFlux> taus) {
  std::vector<Bound> found(of.size());
  if (of.empty()) return found;
  const std::size_t triangles = of.front().primal->cut.triangle_count(),
                    blocks = (triangles + some_triangles - 1) / some_triangles;
  std::deque<Sum> sums;
  std::vector<Parts> parts(of.size());
  for (std::size_t i = 0; i < of.size(); ++i) {
    sums.emplace_back(*of[i].primal, of[i].dual, taus[i]);
    if (of[i].parts) parts[i].primal = parts[i].dual = std::vector<double>(triangles);
  }
  std::vector<Products> products(blocks * of.size());
  base::at_once(blocks, base::Threads::allowed(), [&] {
    return [&](std::size_t block) {
      for (std::size_t i = 0; i < of.size(); ++i)
        products[block * of.size() + i] = sums[i].products(block * some_triangles, parts[i]);
    };
  });
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (!weighable(of[i])) continue;
    Products all;
    for (std::size_t block = 0; block < blocks; ++block) all += products[block * of.size() + i];
    found[i] = bound(of[i], taus[i], sums[i], all, std::move(parts[i]));
  }
  return found;
}

}  // namespace

Bound bound(const Aimed& aimed, const EquilibratedFlux& tau) {
  return bounds_by({&aimed, 1}, {&tau, 1}).front();
}

EquilibratedFlux dual_flux(const Primal& primal, const Dual& dual) {
  return EquilibratedFlux(primal.cut, {dual.reacting, {}, {}}, flux_bounds(primal, dual));
}

std::vector<Bound> bounds(const CutMesh& cut, std::span<const Aimed> of) {
  std::vector<FluxBounds> cones;
  std::vector<Balance> balances;
  for (const Aimed& one : of) {
    cones.push_back(flux_bounds(*one.primal, one.dual));
    balances.push_back({one.dual.reacting, {}, {}});
  }
  const std::vector<FaceBounds> of_faces(cones.begin(), cones.end());
  return bounds_by(of, EquilibratedFlux::of_all(cut, balances, of_faces, 1, false));
}

}  // namespace anticrack::estimate
