// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangulated rectangles with an interface along y = 0, made without a mesher.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::testing {

/// What lies on the interface between two x that are columns of nodes.
struct OnInterface {
  double from = 0;
  double to = 0;
  mesh::Kind kind = mesh::Kind::delaminated;
  std::int32_t inclusion = 0;
};

/// The paper's inclusion.
inline const std::vector<OnInterface> paper{{-0.5, 0.5, mesh::Kind::delaminated, 0}};
/// More triangles than any test asks for.
inline constexpr std::size_t plenty = 1'000'000;

struct Rectangle {
  double left = -1;
  double right = 1;
  double bottom = -1;
  double top = 1;
};

/// nx by ny squares, ny even, each cut by a diagonal; the line y = (bottom + top)/2 is the
/// interface "sigma", subdomain 0 below it (minus), 1 above, all the outer boundary dirichlet.
inline mesh::Mesh structured_mesh(int nx, int ny, std::span<const OnInterface> parts,
                                  const Rectangle& box = {}) {
  mesh::Mesh made;
  made.subdomains = {"minus", "plus"};
  const auto node = [nx](int i, int j) { return j * (nx + 1) + i; };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      made.xy.push_back(box.left + (box.right - box.left) * i / nx);
      made.xy.push_back(box.bottom + (box.top - box.bottom) * j / ny);
    }
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = node(i, j);
      const int b = node(i + 1, j);
      const int c = node(i + 1, j + 1);
      const int d = node(i, j + 1);
      made.triangles.insert(made.triangles.end(), {a, b, c, a, c, d});
      made.subdomain.insert(made.subdomain.end(), 2, j < ny / 2 ? 0 : 1);
    }
  }
  mesh::Interface line;
  line.name = "sigma";
  std::int32_t inclusions = 0;
  for (int i = 0; i <= nx; ++i) {
    line.nodes.push_back(node(i, ny / 2));
    if (i == nx) break;
    const double middle = box.left + (box.right - box.left) * (i + 0.5) / nx;
    mesh::Kind kind = mesh::Kind::glue;
    std::int32_t inclusion = -1;
    for (const OnInterface& part : parts) {
      if (part.from < middle && middle < part.to) {
        kind = part.kind;
        inclusion = part.inclusion;
      }
    }
    line.kind.push_back(kind);
    line.inclusion.push_back(inclusion);
    inclusions = inclusion >= inclusions ? inclusion + 1 : inclusions;
  }
  for (std::int32_t k = 0; k < inclusions; ++k) {
    made.inclusions.push_back("inclusion" + std::to_string(k));
  }
  made.interfaces.push_back(line);
  for (int i = 0; i < nx; ++i) {
    made.dirichlet.push_back({node(i, 0), node(i + 1, 0)});
    made.dirichlet.push_back({node(i + 1, ny), node(i, ny)});
  }
  for (int j = 0; j < ny; ++j) {
    made.dirichlet.push_back({node(nx, j), node(nx, j + 1)});
    made.dirichlet.push_back({node(0, j + 1), node(0, j)});
  }
  return made;
}

}  // namespace anticrack::testing
