// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/load_balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr double trace_constant = 0.329;
constexpr const char* balancing = "balancing a load";

/// The diameter of a triangle over the root of its least tension: with it, Poincare's inequality
/// and the trace inequality hold in the energy norm.
double size_of(const CutMesh& cut, std::size_t t) {
  const auto corner = [&](std::size_t i) { return cut.at[at(cut.copy[3 * t + i])]; };
  const Vector p = corner(0), q = corner(1), r = corner(2);
  const Vector before[] = {
      {r[0] - q[0], r[1] - q[1]}, {p[0] - r[0], p[1] - r[1]}, {q[0] - p[0], q[1] - p[1]}};
  const Vector b = cut.shapes.side(3 * t), c = cut.shapes.side(3 * t + 1);
  const double squared =
      std::max({dot(before[0], before[0]), dot(before[1], before[1]), dot(before[2], before[2])});
  // The map has the determinant 1; its greatest stretch follows from its trace.
  const double twice = before[0][0] * before[1][1] - before[0][1] * before[1][0];
  const double trace =
      (b[0] * before[1][1] - c[0] * before[0][1] + c[1] * before[0][0] - b[1] * before[1][0]) /
      twice;
  const double stretch = 0.5 * (trace + std::sqrt(std::max(0.0, trace * trace - 4)));
  return std::sqrt(squared / cut.shapes.tension[t]) * std::max(1.0, stretch) *
         (cut.shapes.variation.empty() ? 1 : cut.shapes.variation[t].below);
}

/// Adds |tau| for the sources of all triangles, and their effect on the w of bracket.hpp, which is
/// not 0 on all sides of its triangle.
void carry_out(const CutMesh& cut, std::vector<double>& source, std::vector<double>& oscillation) {
  const Shapes& shapes = cut.shapes;
  std::vector<double> through(source.size(), 0);  // flux in plus flux out
  std::vector<char> led(source.size(), 0);
  for (auto way = cut.ways_out.rbegin(); way != cut.ways_out.rend(); ++way) {
    stop::look_at_turn<stop::quick>(at(way - cut.ways_out.rbegin()), balancing);
    const std::size_t t = at(way->side / 3);
    led[t] = 1;
    through[t] += source[t];
    if (way->into < 0) continue;
    const std::size_t next = at(way->into / 3);
    through[next] += source[t];
    source[next] += source[t];
  }
  for (std::size_t t = 0; t < source.size(); ++t) {
    stop::look_at_turn<stop::quick>(t, balancing);
    if (source[t] == 0 && through[t] == 0) continue;
    if (led[t] == 0) {
      oscillation[t] = std::numeric_limits<double>::infinity();
      continue;
    }
    // A flux of 1 through a side, (x - P) / (2 area), is at most |e| long.
    double longest = 0;
    for (std::size_t i = 3 * t; i < 3 * t + 3; ++i)
      longest = std::max(longest, dot(shapes.edge[i], shapes.edge[i]));
    const double below = shapes.variation.empty() ? 1 : shapes.variation[t].below;
    oscillation[t] += below * std::sqrt(longest) * (through[t] + 2 / j_11 * source[t]);
  }
}

}  // namespace

LoadBalance load_balance(const CutMesh& cut, std::vector<double> load,
                         const std::vector<fem::ForceParts>& force,
                         const std::vector<fem::TractionParts>& traction) {
  LoadBalance balance{std::move(load), {}, {}, {}};
  const auto oscillation = [&](std::size_t t) -> double& {
    balance.oscillation.resize(cut.triangle_count(), 0);
    balance.moments.resize(cut.triangle_count(), 0);
    return balance.oscillation[t];
  };
  std::vector<double> source;
  const auto unknown = [&](std::size_t t, double amount) {
    if (amount == 0) return;
    source.resize(cut.triangle_count(), 0);
    source[t] += amount;
    balance.unknown += amount;
  };
  for (std::size_t s = 0; s < force.size(); ++s) {
    const auto first = at(cut.first_triangle[s]);
    for (std::size_t k = 0; k < force[s].beyond.size(); ++k) {
      stop::look_at_turn(k, balancing);
      oscillation(first + k) += size_of(cut, first + k) / j_11 * force[s].beyond[k];
      unknown(first + k, force[s].unknown[k]);
      balance.moments[first + k] += force[s].moments[k];
    }
  }
  std::vector<double> beyond, of_edges;
  for (const fem::TractionParts& parts : traction) {
    balance.traction.insert(balance.traction.end(), parts.load.begin(), parts.load.end());
    beyond.insert(beyond.end(), parts.beyond.begin(), parts.beyond.end());
    of_edges.insert(of_edges.end(), parts.unknown.begin(), parts.unknown.end());
  }
  for (const Face& face : cut.faces) {
    if (beyond.empty() || face.traction < 0) continue;
    const std::size_t t = at(face.side / 3), i = at(face.side % 3);
    const Vector &p = cut.at[at(cut.copy[3 * t + (i + 1) % 3])],
                 &q = cut.at[at(cut.copy[3 * t + (i + 2) % 3])];
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    if (beyond[at(face.traction)] == 0 && of_edges[at(face.traction)] == 0) continue;
    const double on_edge = size_of(cut, t) *
                           std::sqrt(trace_constant * length / cut.shapes.area[t]) *
                           beyond[at(face.traction)];
    oscillation(t) += on_edge;
    balance.moments[t] = std::numeric_limits<double>::infinity();
    unknown(t, of_edges[at(face.traction)]);
  }
  if (!source.empty()) {
    balance.oscillation.resize(cut.triangle_count(), 0);
    carry_out(cut, source, balance.oscillation);
  }
  return balance;
}

}  // namespace anticrack::estimate
