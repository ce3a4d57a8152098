// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/lack.hpp"

#include <algorithm>

#include "base/at.hpp"

namespace anticrack::estimate {
namespace {

/// The force on a body, and the moment about Ways::Body::from.
struct OnBody {
  double force = 0;
  Vector moment{};
  double beyond = 0;  ///< sum of the inadmissible fluxes through its faces

  void add(double by, const Vector& from, const Vector& x) {
    force += by;
    moment[0] += by * (x[0] - from[0]);
    moment[1] += by * (x[1] - from[1]);
  }
};

}  // namespace

Lack lack_of(const CutMesh& cut, const EquilibratedFlux& flux, std::span<const double> traction,
             std::span<const ForceOn> forces, std::span<const double> kept,
             std::span<const double> reactions) {
  const Ways& ways = cut.ways;
  if (!std::isfinite(ways.triangle)) return {Ways::none, 0};
  const std::vector<double>& through = flux.through_faces();
  std::vector<OnBody> on(ways.bodies.size());
  for (std::size_t j = 0; j < forces.size(); ++j) {
    const auto b = at(ways.of[j]);
    on[b].add(-forces[j].force, ways.bodies[b].from, cut.centre[j]);
    on[b].moment[0] -= forces[j].moment[0];
    on[b].moment[1] -= forces[j].moment[1];
  }
  double sides = flux.imbalance();
  Lack lack;
  lack.work = sides;
  for (std::size_t f = 0; f < cut.faces.size(); ++f) {
    const Face& face = cut.faces[f];
    const double* own = &through[2 * f];
    const auto ends = cut.ends(face);
    OnBody* const body = face.inclusion < 0 ? nullptr : &on[at(ways.of[at(face.inclusion)])];
    if (body != nullptr) {
      const Vector& from = ways.bodies[at(ways.of[at(face.inclusion)])].from;
      for (const std::size_t end : {0, 1}) body->add(own[end], from, cut.at[at(ends[end])]);
    }
    if (face.condition == Condition::given) {
      const bool loaded = face.traction >= 0 && !traction.empty();
      for (const std::size_t end : {0, 1}) {
        const double load = loaded ? traction[2 * at(face.traction) + end] : 0;
        sides += std::abs(own[end] - load);
        lack.work += std::abs(own[end] - load);
      }
    }
    if (!presses(face.condition)) continue;
    const double beyond = std::abs(own[0] + own[1] - kept[f]);
    sides += beyond;
    if (body != nullptr) body->beyond += beyond;
    const auto unexplained = [&](std::size_t end, double outward) {
      return reactions.empty() ? 0 : std::abs(outward - reactions[2 * f + end]);
    };
    for (const std::size_t end : {0, 1}) lack.work += unexplained(end, own[end]);
    if (face.condition != Condition::crack_minus) continue;
    const double* other = &through[2 * at(face.other)];
    sides += std::abs(other[0] + other[1] + kept[f]);
    for (const std::size_t end : {0, 1})
      lack.work += std::abs(own[end] + other[1 - end]) + unexplained(end, -other[1 - end]);
  }
  lack.flux = ways.triangle * sides;
  for (std::size_t b = 0; b < on.size(); ++b) {
    const Ways::Body& body = ways.bodies[b];
    if (body.held) continue;
    const double force = std::abs(on[b].force), turning = body.turning(on[b].moment);
    lack.work += force + (turning > 0 ? turning * body.slope : 0);
    lack.flux +=
        (force + on[b].beyond) * body.force + (turning + on[b].beyond * body.extent) * body.moment;
  }
  return lack;
}

std::vector<double> pressing(const CutMesh& cut, const EquilibratedFlux& flux) {
  std::vector<double> kept(cut.faces.size(), 0);
  const std::vector<double>& through = flux.through_faces();
  for (std::size_t f = 0; f < kept.size(); ++f)
    if (presses(cut.faces[f].condition))
      kept[f] = std::min(0.0, through[2 * f] + through[2 * f + 1]);
  return kept;
}

}  // namespace anticrack::estimate
