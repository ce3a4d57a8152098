// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/load_balance.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/at.hpp"

namespace anticrack::estimate {
namespace {

constexpr double trace_constant = 0.329;

struct Shape {
  double area;
  double diameter;
};

Shape shape_of(const CutMesh& cut, std::size_t t) {
  const auto place = [&](std::size_t i) { return cut.at[at(cut.copy[3 * t + i % 3])]; };
  const auto [px, py] = place(0);
  const auto [qx, qy] = place(1);
  const auto [rx, ry] = place(2);
  Shape shape{0.5 * ((qx - px) * (ry - py) - (qy - py) * (rx - px)), 0};
  for (std::size_t i = 0; i < 3; ++i) {
    shape.diameter = std::max(
        shape.diameter, std::hypot(place(i + 1)[0] - place(i)[0], place(i + 1)[1] - place(i)[1]));
  }
  return shape;
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
      const Shape shape = shape_of(cut, first + k);
      oscillation(first + k) +=
          shape.diameter / (j_11 * std::sqrt(cut.tension[s])) *
          std::sqrt(beyond_linear(force[s].square[k], &force[s].load[3 * k], shape.area));
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
    const Shape shape = shape_of(cut, t);
    const auto s = std::upper_bound(cut.first_triangle.begin(), cut.first_triangle.end(),
                                    static_cast<std::int32_t>(t)) -
                   cut.first_triangle.begin() - 1;
    oscillation(t) += std::sqrt(trace_constant * length * shape.diameter * shape.diameter /
                                (shape.area * cut.tension[static_cast<std::size_t>(s)]) * beyond);
  }
  return balance;
}

}  // namespace anticrack::estimate
