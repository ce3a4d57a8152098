// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/load_balance.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr double trace_constant = 0.329;

/// The diameter of a triangle after the map of its tension over the root of that tension, by which
/// Poincare's and the trace inequality hold in the energy norm.
double size_of(const Shapes& shapes, std::size_t t) {
  double squared = 0;
  for (std::size_t i = 3 * t; i < 3 * t + 3; ++i)
    squared = std::max(squared, dot(shapes.edge[i], shapes.edge[i]));
  return 2 * std::sqrt(squared * shapes.area[t]) *
         (shapes.variation.empty() ? 1 : shapes.variation[t].below);
}

/// int (f - P_1 f)^2, from int f^2 and int f phi_i.
double beyond_linear(double square, const double* load, double area) {
  const double sum = load[0] + load[1] + load[2];
  double linear = 0;
  for (std::size_t i = 0; i < 3; ++i) linear += 12 / area * (load[i] - sum / 4) * load[i];
  return std::max(0.0, square - linear);
}

}  // namespace

LoadBalance load_balance(const CutMesh& cut, const std::vector<fem::ForceParts>& force,
                         const std::vector<fem::TractionParts>& traction) {
  LoadBalance balance;
  balance.force.reserve(cut.copy.size());
  const auto oscillation = [&](std::size_t t) -> double& {
    balance.oscillation.resize(cut.triangle_count(), 0);
    return balance.oscillation[t];
  };
  for (std::size_t s = 0; s < force.size(); ++s) {
    const auto first = at(cut.first_triangle[s]);
    balance.force.insert(balance.force.end(), force[s].load.begin(), force[s].load.end());
    for (std::size_t k = 0; k < force[s].square.size(); ++k) {
      stop::look_at_turn(k, "computing bounds");
      oscillation(first + k) += size_of(cut.shapes, first + k) / j_11 *
                                std::sqrt(beyond_linear(force[s].square[k], &force[s].load[3 * k],
                                                        cut.shapes.area[first + k]));
    }
  }
  std::vector<double> square;
  for (const fem::TractionParts& parts : traction) {
    balance.traction.insert(balance.traction.end(), parts.load.begin(), parts.load.end());
    square.insert(square.end(), parts.square.begin(), parts.square.end());
  }
  if (square.empty()) return balance;
  for (const Face& face : cut.faces) {
    if (face.traction < 0) continue;
    const std::size_t t = at(face.side / 3), i = at(face.side % 3);
    const Vector &p = cut.at[at(cut.copy[3 * t + (i + 1) % 3])],
                 &q = cut.at[at(cut.copy[3 * t + (i + 2) % 3])];
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    const double* load = &balance.traction[2 * at(face.traction)];
    const double sum = load[0] + load[1];
    const double beyond = std::max(0.0, square[at(face.traction)] - sum * sum / length);
    oscillation(t) +=
        size_of(cut.shapes, t) * std::sqrt(trace_constant * length / cut.shapes.area[t] * beyond);
  }
  return balance;
}

}  // namespace anticrack::estimate
