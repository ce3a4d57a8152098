// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/cut_steps.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "base/at.hpp"
#include "base/union_find.hpp"
#include "errors/errors.hpp"
#include "mesh/edges.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

using EdgeKey = std::pair<std::int32_t, std::int32_t>;

std::vector<char> dirichlet_nodes(const mesh::Mesh& mesh) {
  std::vector<char> on_dirichlet(mesh.node_count(), 0);
  for (const auto& edge : mesh.dirichlet) on_dirichlet[at(edge[0])] = on_dirichlet[at(edge[1])] = 1;
  return on_dirichlet;
}

std::vector<CutEdge> list_edges(const mesh::Mesh& mesh) {
  std::size_t count = 0;
  for (const mesh::Interface& interface : mesh.interfaces) count += interface.kind.size();
  std::vector<CutEdge> edges;
  edges.reserve(count);
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const mesh::Interface& interface = mesh.interfaces[i];
    for (std::size_t e = 0; e < interface.kind.size(); ++e) {
      CutEdge edge;
      edge.interface = static_cast<std::int32_t>(i);
      edge.kind = interface.kind[e];
      edge.inclusion = interface.inclusion[e];
      edge.node = {interface.nodes[e], interface.nodes[e + 1]};
      edges.push_back(edge);
    }
  }
  return edges;
}

/// The triangles that touch an interface, and the fans that their corners form.
class Neighbourhood {
 public:
  Neighbourhood(const mesh::Mesh& mesh, const std::vector<CutEdge>& edges)
      : _mesh(mesh),
        _triangles(touching(mesh, edges)),
        _table(corners_of(mesh, _triangles)),
        _fans(3 * _triangles.size()) {
    join_fans(edges);
  }

  /// The fans on the left of a -> b at a and at b, each by the local number of one of its corners;
  /// -1 if the edge has no triangle there.
  std::array<std::int32_t, 2> left(std::int32_t a, std::int32_t b) {
    for (const mesh::EdgeUse& use : _table.find(a, b))
      if (use.from == a)
        return {_fans.find(corner(use.triangle, a)), _fans.find(corner(use.triangle, b))};
    return {-1, -1};
  }
  const std::vector<std::int32_t>& triangles() const { return _triangles; }
  std::int32_t fan(std::size_t local_corner) {
    return _fans.find(static_cast<std::int32_t>(local_corner));
  }
  std::int32_t subdomain(std::int32_t fan) const {
    return _mesh.subdomain[at(_triangles[at(fan / 3)])];
  }

 private:
  static std::vector<std::int32_t> touching(const mesh::Mesh& mesh,
                                            const std::vector<CutEdge>& edges) {
    std::vector<char> on_interface(mesh.node_count(), 0);
    for (const CutEdge& edge : edges)
      on_interface[at(edge.node[0])] = on_interface[at(edge.node[1])] = 1;
    std::vector<std::int32_t> triangles;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      stop::look_at_turn<stop::quick>(t, "finding the triangles at interfaces");
      const std::int32_t* node = &mesh.triangles[3 * t];
      if (on_interface[at(node[0])] + on_interface[at(node[1])] + on_interface[at(node[2])] > 0)
        triangles.push_back(static_cast<std::int32_t>(t));
    }
    return triangles;
  }

  static std::vector<std::int32_t> corners_of(const mesh::Mesh& mesh,
                                              const std::vector<std::int32_t>& triangles) {
    std::vector<std::int32_t> corners;
    corners.reserve(3 * triangles.size());
    for (const std::int32_t t : triangles) {
      const auto first = mesh.triangles.begin() + 3 * static_cast<std::ptrdiff_t>(t);
      corners.insert(corners.end(), first, first + 3);
    }
    return corners;
  }

  std::int32_t corner(std::int32_t local_triangle, std::int32_t node) const {
    const std::int32_t* first = &_mesh.triangles[3 * at(_triangles[at(local_triangle)])];
    return 3 * local_triangle +
           static_cast<std::int32_t>(std::find(first, first + 3, node) - first);
  }

  void join_fans(const std::vector<CutEdge>& edges) {
    std::vector<EdgeKey> cuts;
    cuts.reserve(edges.size());
    for (const CutEdge& edge : edges) cuts.push_back(std::minmax(edge.node[0], edge.node[1]));
    std::sort(cuts.begin(), cuts.end());
    _table.each([&](std::span<const mesh::EdgeUse> uses) {
      const EdgeKey key{uses[0].low(), uses[0].high()};
      if (uses.size() < 2 || std::binary_search(cuts.begin(), cuts.end(), key)) return;
      for (const std::int32_t node : {key.first, key.second})
        _fans.unite(corner(uses[0].triangle, node), corner(uses[1].triangle, node));
    });
  }

  const mesh::Mesh& _mesh;
  std::vector<std::int32_t> _triangles;
  mesh::EdgeTable _table;
  base::UnionFind _fans;
};

void require_two_faces(const mesh::Mesh& mesh, const CutEdge& edge, Neighbourhood& around) {
  const std::int32_t plus = around.left(edge.node[0], edge.node[1])[0];
  const std::int32_t minus = around.left(edge.node[1], edge.node[0])[0];
  const bool two = plus >= 0 && minus >= 0;
  if (two && (edge.kind != mesh::Kind::glue || around.subdomain(plus) != around.subdomain(minus)))
    return;
  throw errors::Error(errors::Reason::mesh_invalid, "the interface edge from {} to {}{}",
                      place(mesh, edge.node[0]), place(mesh, edge.node[1]),
                      two ? " is glue, but has the subdomain \"" +
                                mesh.subdomains[at(around.subdomain(plus))] + "\" on both sides"
                          : std::string(" does not have a triangle on each side"));
}

}  // namespace

std::string place(const mesh::Mesh& mesh, std::int32_t node) {
  return errors::shown(mesh.xy[2 * at(node)], mesh.xy[2 * at(node) + 1]);
}

Sides find_sides(const mesh::Mesh& mesh) {
  Sides result;
  result.edges = list_edges(mesh);
  result.on_dirichlet = dirichlet_nodes(mesh);
  result.corner.assign(mesh.triangles.size(), -1);
  Neighbourhood around(mesh, result.edges);

  std::vector<std::int32_t> number(3 * around.triangles().size(), -1);
  const auto side = [&](std::int32_t fan, std::int32_t node) {
    if (result.on_dirichlet[at(node)] != 0) return -1;
    if (number[at(fan)] < 0) {
      number[at(fan)] = static_cast<std::int32_t>(result.sides.size());
      result.sides.push_back({node, around.subdomain(fan)});
    }
    return number[at(fan)];
  };
  std::vector<char> on_interface(mesh.node_count(), 0);
  for (CutEdge& edge : result.edges) {
    require_two_faces(mesh, edge, around);
    const auto [a, b] = edge.node;
    const auto plus = around.left(a, b), minus = around.left(b, a);
    edge.minus[0] = side(minus[1], a);
    edge.plus[0] = side(plus[0], a);
    edge.minus[1] = side(minus[0], b);
    edge.plus[1] = side(plus[1], b);
    on_interface[at(a)] = on_interface[at(b)] = 1;
  }
  // Where the membrane pinches, a fan may touch the node without having an interface edge.
  for (std::size_t i = 0; i < number.size(); ++i) {
    const std::size_t corner = 3 * at(around.triangles()[i / 3]) + i % 3;
    if (const std::int32_t node = mesh.triangles[corner]; on_interface[at(node)] != 0)
      result.corner[corner] = side(around.fan(i), node);
  }
  return result;
}

}  // namespace anticrack::ddm
