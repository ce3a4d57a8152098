// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/base_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "mesher/helper.hpp"
#include "support/paper_geometry.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::accuracy {
mesh::Mesh diagonals(mesh::Kind condition) {
  testing::StructuredOptions options;
  options.columns = 8;
  options.rows = 4;
  options.kind = [condition](double x) { return std::abs(x) < 0.5 ? condition : mesh::Kind::glue; };
  if (condition == mesh::Kind::crack || condition == mesh::Kind::free) {
    options.inclusions.clear();
  }
  return testing::structured_mesh(options);
}

mesh::Mesh rectangles() { return testing::structured_mesh({12, 5, {}, {}, {"stiffener"}}); }

mesh::Mesh shaken(unsigned seed) {
  mesh::Mesh mesh = diagonals();
  std::mt19937 random(seed);
  // Multiples of 2^-10 keep midpoints exact in all the bisections that follow.
  std::uniform_int_distribution<int> step(-56, 56);
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    double &x = mesh.xy[2 * i], &y = mesh.xy[2 * i + 1];
    if (std::abs(x) == 1 || std::abs(y) == 1) {
      continue;
    }
    const double dx = std::ldexp(step(random), -10), dy = std::ldexp(step(random), -10);
    if (y != 0) {
      x += dx;
      y += dy;
    } else if (std::abs(x) != 0.5) {
      x += dx;
    }
  }
  return mesh;
}

mesh::Mesh generated(double h0) {
  mesh::MeshOptions options;
  options.size = h0;
  return generated(options);
}

mesh::Mesh generated(const mesh::MeshOptions& options) {
  return generated(testing::paper_geometry(), options);
}

mesh::Mesh generated(const mesh::Geometry& geometry, const mesh::MeshOptions& options) {
  mesher::HelperOptions helper;
  helper.executable = ANTICRACK_MESHER;
  constexpr std::size_t limit = 1'000'000;
  return mesher::run(helper, mesh::GenerateRequest{mesh::plan(geometry, options, limit), limit},
                     {});
}

mesh::Mesh turned(mesh::Mesh mesh) {
  for (mesh::Interface& interface : mesh.interfaces) {
    std::reverse(interface.nodes.begin(), interface.nodes.end());
    std::reverse(interface.kind.begin(), interface.kind.end());
    std::reverse(interface.inclusion.begin(), interface.inclusion.end());
  }
  return mesh;
}

mesh::Mesh mirrored(mesh::Mesh mesh, Mirror mirror) {
  for (std::size_t i = mirror == Mirror::x ? 0 : 1; i < mesh.xy.size(); i += 2) {
    mesh.xy[i] = -mesh.xy[i];
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::swap(mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]);
  }
  return turned(std::move(mesh));
}

Placement::Placement(double angle, double scale)
    : _cos(scale * std::cos(angle)), _sin(scale * std::sin(angle)) {}

mesh::Point Placement::operator()(const mesh::Point& p) const {
  return {_cos * p[0] - _sin * p[1], _sin * p[0] + _cos * p[1]};
}

mesh::Mesh Placement::operator()(mesh::Mesh mesh) const {
  for (std::size_t i = 0; i < mesh.xy.size(); i += 2) {
    const mesh::Point moved = (*this)({mesh.xy[i], mesh.xy[i + 1]});
    std::copy(moved.begin(), moved.end(), mesh.xy.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return mesh;
}

}  // namespace anticrack::accuracy
