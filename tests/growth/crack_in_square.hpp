// SPDX-License-Identifier: GPL-3.0-or-later
//
// The square cut by a line on which fronts move, with a crack whose energy is known and a bonded
// inclusion under contact.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "growth/on_line.hpp"
#include "operators/mesh_operator.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::testing {

using mesh::Kind;

using KindOf = std::function<Kind(double)>;

/// The square (-1,1)^2 cut by y = 0, on which arc length is x + 1, in triangles of sides 1/n.
/// `crooked`: nodes off the lines are moved.
inline mesh::Mesh square(const KindOf& kind, int n, bool crooked = false) {
  StructuredOptions options;
  options.columns = 2 * n;
  options.rows = n;
  options.kind = kind;
  mesh::Mesh mesh = structured_mesh(options);
  if (std::ranges::all_of(mesh.interfaces[0].inclusion, [](std::int32_t j) { return j < 0; }))
    mesh.inclusions.clear();
  for (std::size_t i = 0; crooked && i < mesh.node_count(); ++i) {
    double &x = mesh.xy[2 * i], &y = mesh.xy[2 * i + 1];
    if (std::abs(x) == 1 || std::abs(y) == 1 || y == 0) continue;
    const auto k = static_cast<double>(i);
    x += 0.25 / n * std::sin(3 * k);
    y += 0.25 / n * std::cos(5 * k + 1);
  }
  return mesh;
}

struct OnMesh {
  std::shared_ptr<const operators::MeshOperator> op;
  operators::PreparedLoad load;
};

inline OnMesh prepared(mesh::Mesh mesh, const fem::Load& load) {
  auto op = operators::MeshOperator::factorise(std::make_shared<const mesh::Mesh>(std::move(mesh)),
                                               2, {});
  const fem::Load* const one[] = {&load};
  auto outcome = std::move(op->prepare(one).front());
  if (const auto* error = std::get_if<errors::Error>(&outcome)) throw errors::Error(*error);
  return {op, std::get<operators::PreparedLoad>(outcome)};
}

inline fem::Load load_of(const std::string& boundary, const std::string& force = "") {
  fem::Load load;
  load.name = "case";
  load.boundary_value = boundary;
  if (!force.empty()) load.force = fem::Expression{force};
  return load;
}

/// sn(u | m) by descending Landen transformations.
inline double sn(double u, double m) {
  if (m < 1e-30) return std::sin(u);
  const double low = (1 - std::sqrt(1 - m)) / (1 + std::sqrt(1 - m)), v = u / (1 + low);
  const double below = sn(v, low * low);
  return (1 + low) * below / (1 + low * below * below);
}

inline double elliptic(double m) { return std::comp_ellint_1(std::sqrt(m)); }

/// |u|^2 / 2 of the square with u = +-1 on y = +-1, free sides and a crack |x| < a.
inline double exact_energy(double a) {
  const double m = 0.5, p = std::pow(sn(elliptic(m) * a, m), 2), l = (1 - p) / (1 / m - p);
  return 2 * elliptic(l) / elliptic(1 - l);
}
/// Of each of its tips.
inline double exact_rate(double a) {
  constexpr double step = 1e-4;
  return -(exact_energy(a + step) - exact_energy(a - step)) / (4 * step);
}

inline mesh::Mesh with_free_sides(mesh::Mesh mesh) {
  std::erase_if(mesh.dirichlet, [&](const auto& edge) {
    return std::abs(mesh::position(mesh, edge[0])[0]) == 1 &&
           std::abs(mesh::position(mesh, edge[1])[0]) == 1;
  });
  return mesh;
}

/// Two paths from |x| = 1/4 to 3/4, and states with both fronts at |x| = half.
inline const std::vector<growth::Path> both_ways = {on_line(0.25, 0.75, "1"),
                                                    on_line(1.25, 1.75, "1")};

inline KindOf within(double end, Kind inside, Kind outside) {
  return [=](double x) { return std::abs(x) < end ? inside : outside; };
}

/// An inclusion that is bonded but in its middle, pushed at its right so that the part that is off
/// is partly in contact.
struct Bonded {
  static constexpr int n = 32;
  static constexpr double from = -0.5, to = 0, end = 0.75;
  static Kind opened(double x) {
    return std::abs(x) > end ? Kind::glue : x < from ? Kind::inclusion : Kind::delaminated;
  }
  static fem::Load load(double size = 1) {
    const std::string by = std::to_string(size);
    return load_of("0", by + "*(y > 0 ? 2 : x < -0.25 ? 14 : -10)");
  }
  static std::vector<growth::Path> paths() { return {on_line(1 + to, 1 + end, "0.1")}; }
};

}  // namespace anticrack::testing
