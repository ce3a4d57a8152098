// SPDX-License-Identifier: GPL-3.0-or-later
//
// A mesh made up without a server: the grid of sample_result, drawn towards one tip, with every
// kind of interface and of boundary.
#pragma once

#include <cmath>
#include <cstdint>

#include "results/mesh_plan.hpp"
#include "support/sample_result.hpp"

namespace anticrack::testing {

/// t in (-1,1), drawn towards `centre` as its distance to the power `power`.
inline double drawn_towards(double t, double centre, double power) {
  const double reach = t < centre ? 1 + centre : 1 - centre;
  const double part = std::abs(t - centre) / reach;
  return centre + std::copysign(reach * std::pow(part, power), t - centre);
}

/// Interfaces: "sigma" along y = 0, with a crack, an inclusion bonded and delaminated, and glue;
/// and "slit" along x = 0 for y > 0.5. n has to be a multiple of 10. Traction is given where x = 1.
inline results::MeshPlan sample_mesh_plan(int n, double power = 1) {
  results::MeshPlan plan;
  plan.title = "A made-up mesh";
  plan.mesh = sample_mesh(n);
  const int side = 2 * n + 1;
  results::InterfaceLine sigma{"sigma", {}, {}};
  for (int i = 0; i < side; ++i) {
    sigma.nodes.push_back(n * side + i);
    if (i + 1 == side) break;
    const double x = -1 + (i + 0.5) / n;
    const bool inclusion = x > -0.3 && x < 0.5;
    sigma.edges.kind.push_back(x > -0.8 && x < -0.5 ? results::Kind::crack
                               : !inclusion         ? results::Kind::glue
                               : x < 0.1            ? results::Kind::inclusion
                                                    : results::Kind::delaminated);
    sigma.edges.inclusion.push_back(inclusion ? 0 : -1);
  }
  results::InterfaceLine slit{"slit", {}, {}};
  for (int j = n + n / 2; j < side; ++j) {
    slit.nodes.push_back(j * side + n);
    if (j + 1 == side) break;
    slit.edges.kind.push_back(results::Kind::free);
    slit.edges.inclusion.push_back(-1);
  }
  plan.interfaces = {sigma, slit};

  std::vector<std::int32_t> prescribed;
  for (std::size_t b = 0; b < plan.mesh.boundary.size(); b += 2) {
    const auto a = static_cast<std::size_t>(plan.mesh.boundary[b]);
    const auto c = static_cast<std::size_t>(plan.mesh.boundary[b + 1]);
    if (plan.mesh.xy[2 * a] == 1 && plan.mesh.xy[2 * c] == 1) continue;
    prescribed.insert(prescribed.end(), {plan.mesh.boundary[b], plan.mesh.boundary[b + 1]});
  }
  plan.mesh.boundary = prescribed;

  const double step = std::pow(1.0 / n, power);
  for (std::size_t i = 0; i < plan.mesh.node_count(); ++i) {
    plan.mesh.xy[2 * i] = drawn_towards(plan.mesh.xy[2 * i], 0.5, power);
    plan.mesh.xy[2 * i + 1] = drawn_towards(plan.mesh.xy[2 * i + 1], 0, power);
  }
  for (const double x : {-0.8, -0.5, -0.3, 0.1, 0.5}) {
    const double edge = x == 0.5 ? step : 1.0 / n;
    plan.tips.push_back({drawn_towards(x, 0.5, power), 0, edge});
  }
  plan.tips.push_back({drawn_towards(0, 0.5, power), drawn_towards(0.5, 0, power), 1.0 / n});
  return plan;
}

}  // namespace anticrack::testing
