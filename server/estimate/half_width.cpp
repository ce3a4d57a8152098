// SPDX-License-Identifier: GPL-3.0-or-later
// R(c) of interval.hpp from its terms.
#include <algorithm>
#include <cmath>

#include "estimate/interval.hpp"

namespace anticrack::estimate {
namespace {

/// The least R of two parts over c_s >= c[0] and stiff c_s >= c[1]; the formula without parts has
/// stiff = 1.
struct BestOfParts {
  HalfWidth half{};
  ConeSize cone{};
  double value = std::numeric_limits<double>::infinity();

  BestOfParts(const std::array<PartNorms, 2>& norms, double coupling, std::array<double, 2> c) {
    constexpr int steps = 400;
    constexpr double per_decade = 20;
    for (int k = -steps; k <= steps; ++k) {
      const double stiff = std::pow(10, k / per_decade), least = std::max(c[0], c[1] / stiff);
      const std::optional<HalfWidth> tried = half_of_parts(norms, coupling, stiff);
      if (!tried || !((*tried)(least) < value)) continue;
      half = *tried;
      cone = {least, stiff};
      value = half(least);
    }
  }
};

std::array<PartNorms, 2> norms_of(const Terms& of) {
  std::array<PartNorms, 2> norms;
  for (const std::size_t p : {0, 1}) {
    const PartTerms& part = of.parts[p];
    const double o = std::sqrt(part.unbalanced.squared), own = std::sqrt(part.distance),
                 d = (std::sqrt(part.distance + part.unbalanced.squared +
                                2 * part.unbalanced.primal) +
                      of.s) /
                     2;
    norms[p] = {d * d + part.pressure, std::sqrt(part.square) + of.t,
                (own + of.s + (p == 0 ? 3 : 1) * o) / 2};
  }
  return norms;
}

}  // namespace

std::optional<HalfWidth> half_of_parts(const std::array<PartNorms, 2>& of, double coupling,
                                       double stiff) {
  const auto& [rest, part] = of;
  const double g = coupling * std::abs(stiff - 1), determinant = 4 * stiff - g * g;
  if (!(determinant > 0)) return std::nullopt;
  const double a = g * rest.reach, b = g * part.reach;
  const auto form = [&](double a1, double b1, double a2, double b2) {
    return (a1 * a2 + stiff * b1 * b2 + g * (a1 * b2 + a2 * b1) / 2) / determinant;
  };
  return HalfWidth{
      stiff * part.energy + rest.energy + g * part.reach * rest.reach + form(a, b, a, b),
      2 * form(part.flux, rest.flux, a, b), form(part.flux, rest.flux, part.flux, rest.flux)};
}

Bound bound_of(const Terms& of, Side side, double c, double most) {
  const Unbalanced& rest = of.unbalanced;
  const Weighted& weighted = of.weighted;
  const double lacking = 0.5 * (std::sqrt(of.square) * of.s +
                                of.t * std::sqrt(std::max(0.0, of.distance)) + of.s * of.t);
  const double distance = of.distance + rest.squared + 2 * rest.primal + weighted.primal;
  const double e = (std::sqrt(std::max(0.0, distance)) + std::sqrt(weighted.most_primal) * of.s) /
                   2,
               f = (std::sqrt(of.square + weighted.dual) + std::sqrt(weighted.most_dual) * of.t) /
                   2;
  Bound found;
  found.half = {e * e + of.pressure,
                (weighted.mixed + rest.dual + of.t * std::sqrt(rest.squared)) / 2 +
                    weighted.most_mixed * lacking,
                f * f};
  found.c = c;
  found.used = c / most;
  found.estimate = of.mixed;
  found.short_of = std::sqrt(found.half.dual / found.half.primal) / most;
  found.middle = of.value + of.work + of.residual + of.mixed;
  if (of.coupling >= 0) {
    const std::array<PartNorms, 2> norms = norms_of(of);
    const double mixed = found.half.mixed;
    const BestOfParts best(norms, of.coupling, {of.parts[0].c, of.parts[1].c});
    if (best.value + mixed < found.half(c)) {
      found.half = best.half;
      found.half.mixed += mixed;
      found.c = best.cone.c;
      found.stiff = best.cone.stiff;
    }
    const BestOfParts any(norms, of.coupling, {0, 0});
    found.wanted = {any.half.best(0), any.cone.stiff};
  }
  const double extra = of.extra + lacking + 1e-12 * (std::abs(of.value) + std::abs(found.middle));
  found.value = found.middle + (side == Side::upper ? 1 : -1) * (found.half(found.c) + extra);
  return found;
}

double first_cone(double compliance, double norm_squared) {
  return 2 * (norm_squared > 0 ? std::sqrt(compliance / norm_squared) : 1);
}

std::vector<double> cones_about(double first) {
  std::vector<double> cones;
  for (int k = -3; k <= 11; ++k) cones.push_back(first * std::exp2(0.5 * k));
  return cones;
}

Promise choose_cone(std::span<const Clipped> of, double primal, double dual) {
  Promise best;
  for (const Clipped& one : of) {
    const double half_width = HalfWidth{primal, 0, dual + one.apart / 4}(one.c);
    if (half_width < best.half_width) best = {one, half_width};
  }
  return best;
}

std::optional<Clipped> next_cone(std::span<const Clipped> known, const Clipped& last,
                                 const Bound& found) {
  constexpr double worth = 0.1, far_short = 2;
  if (!std::isfinite(found.value)) return Clipped{8 * last.c};
  const bool foreseen = !std::isnan(last.apart);
  if (foreseen) {
    const HalfWidth now{found.half.primal, 0, found.half.dual};
    const Promise next = choose_cone(known, now.primal, std::max(0.0, now.dual - last.apart / 4));
    if (next.half_width < (1 - worth) * now(found.c)) return next.cone;
  }
  if (!(found.short_of > (foreseen ? far_short : 1))) return std::nullopt;
  return Clipped{last.c * std::clamp(found.short_of, 1.5, 8.0)};
}

double HalfWidth::best(double c) const {
  return primal > 0 ? std::max(c, std::sqrt(dual / primal))
                    : std::numeric_limits<double>::infinity();
}

double HalfWidth::operator()(double c) const {
  if (!(primal > 0)) return mixed;  // c' may be as large as it likes
  return best(c) * primal + mixed + (dual > 0 ? dual / best(c) : 0);
}

}  // namespace anticrack::estimate
