// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small meshes of any number of subdomains, with interfaces along the lines of a grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::testing {

/// [0, nx] x [0, ny] in unit squares of two triangles each; nodes have whole coordinates.
class GridMesh {
 public:
  using Point = std::array<int, 2>;

  /// `subdomain`: of the square whose lower left corner is (i, j). The whole boundary is Dirichlet.
  GridMesh(int nx, int ny, std::vector<std::string> subdomains,
           const std::function<int(int, int)>& subdomain)
      : _nx(nx) {
    mesh.subdomains = std::move(subdomains);
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        mesh.xy.insert(mesh.xy.end(), {static_cast<double>(i), static_cast<double>(j)});
      }
    }
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const int a = node({i, j}), b = node({i + 1, j});
        const int c = node({i + 1, j + 1}), d = node({i, j + 1});
        mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
        mesh.subdomain.insert(mesh.subdomain.end(), 2, subdomain(i, j));
      }
    }
    for (int i = 0; i < nx; ++i) {
      mesh.dirichlet.push_back({node({i, 0}), node({i + 1, 0})});
      mesh.dirichlet.push_back({node({i, ny}), node({i + 1, ny})});
    }
    for (int j = 0; j < ny; ++j) {
      mesh.dirichlet.push_back({node({0, j}), node({0, j + 1})});
      mesh.dirichlet.push_back({node({nx, j}), node({nx, j + 1})});
    }
  }

  std::int32_t node(Point p) const { return p[1] * (_nx + 1) + p[0]; }

  /// An interface along straight lines between `corners`; `kinds` of its edges, one after another,
  /// and the inclusion of those that have one.
  GridMesh& add(const std::vector<Point>& corners, const std::vector<mesh::Kind>& kinds,
                std::int32_t inclusion = -1) {
    mesh::Interface interface;
    interface.name = "interface " + std::to_string(mesh.interfaces.size());
    Point here = corners.front();
    interface.nodes.push_back(node(here));
    for (const Point& corner : corners) {
      while (here != corner) {
        for (std::size_t k = 0; k < 2; ++k) {
          here[k] += corner[k] > here[k] ? 1 : corner[k] < here[k] ? -1 : 0;
        }
        interface.nodes.push_back(node(here));
      }
    }
    interface.kind = kinds;
    for (const mesh::Kind kind : kinds) {
      const bool rigid = kind == mesh::Kind::inclusion || kind == mesh::Kind::delaminated;
      interface.inclusion.push_back(rigid ? inclusion : -1);
    }
    mesh.interfaces.push_back(interface);
    return *this;
  }

  /// Frees the edges of the boundary whose middle is where `is_free` says.
  GridMesh& release(const std::function<bool(double, double)>& is_free) {
    std::erase_if(mesh.dirichlet, [&](const std::array<std::int32_t, 2>& edge) {
      const auto a = static_cast<std::size_t>(edge[0]), b = static_cast<std::size_t>(edge[1]);
      return is_free((mesh.xy[2 * a] + mesh.xy[2 * b]) / 2,
                     (mesh.xy[2 * a + 1] + mesh.xy[2 * b + 1]) / 2);
    });
    return *this;
  }

  mesh::Mesh mesh;

 private:
  int _nx;
};

}  // namespace anticrack::testing
