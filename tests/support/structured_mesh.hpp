// SPDX-License-Identifier: GPL-3.0-or-later
//
// A structured mesh of the paper's domain for tests that need no mesher.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::testing {

struct StructuredOptions {
  int columns = 16;  ///< a multiple of 4 puts nodes on the tips at x = -0.5 and 0.5
  int rows = 4;      ///< of each subdomain
  /// Kind of the interface edge whose middle is at x; default: delaminated on (-0.5, 0.5).
  std::function<mesh::Kind(double)> kind;
  /// Inclusion of the edge, asked for kinds that have one; default: 0.
  std::function<std::int32_t(double)> inclusion;
  std::vector<std::string> inclusions = {"stiffener"};
};

/// (-1,1)^2 cut by y = 0 into "lower" (0, minus side, Omega_1) and "upper" (1, plus side, Omega_2),
/// right triangles, u prescribed on the whole outer boundary. One interface, from x = -1 to 1.
inline mesh::Mesh structured_mesh(const StructuredOptions& options = {}) {
  mesh::Mesh mesh;
  mesh.subdomains = {"lower", "upper"};
  mesh.inclusions = options.inclusions;
  const int nx = options.columns, ny = 2 * options.rows;
  const auto node = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      mesh.xy.push_back(-1.0 + 2.0 * i / nx);
      mesh.xy.push_back(-1.0 + 2.0 * j / ny);
    }
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
      mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
      mesh.subdomain.insert(mesh.subdomain.end(), 2, j < options.rows ? 0 : 1);
    }
  }
  for (int i = 0; i < nx; ++i) {
    mesh.dirichlet.push_back({node(i, 0), node(i + 1, 0)});
    mesh.dirichlet.push_back({node(i, ny), node(i + 1, ny)});
  }
  for (int j = 0; j < ny; ++j) {
    mesh.dirichlet.push_back({node(0, j), node(0, j + 1)});
    mesh.dirichlet.push_back({node(nx, j), node(nx, j + 1)});
  }
  mesh::Interface interface;
  interface.name = "sigma";
  for (int i = 0; i <= nx; ++i) {
    interface.nodes.push_back(node(i, options.rows));
  }
  for (int i = 0; i < nx; ++i) {
    const double x = -1.0 + (2.0 * i + 1.0) / nx;
    mesh::Kind kind = std::abs(x) < 0.5 ? mesh::Kind::delaminated : mesh::Kind::glue;
    if (options.kind) {
      kind = options.kind(x);
    }
    const bool rigid = kind == mesh::Kind::inclusion || kind == mesh::Kind::delaminated;
    interface.kind.push_back(kind);
    interface.inclusion.push_back(!rigid ? -1 : options.inclusion ? options.inclusion(x) : 0);
  }
  mesh.interfaces.push_back(interface);
  return mesh;
}

}  // namespace anticrack::testing
