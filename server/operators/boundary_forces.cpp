// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/boundary_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/at.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {
namespace {

using Edge = std::array<std::int32_t, 2>;

/// Rows by the place of the part's name and whether it is free.
using Key = std::pair<std::size_t, bool>;

double length_of(const mesh::Mesh& mesh, const Edge& edge) {
  const auto [a, b] = edge;
  return std::hypot(mesh.xy[2 * at(b)] - mesh.xy[2 * at(a)],
                    mesh.xy[2 * at(b) + 1] - mesh.xy[2 * at(a) + 1]);
}

/// Names of parts, and the part of each edge by its first node.
class Names {
 public:
  Names(const mesh::Mesh& mesh, const std::vector<Edge>& edges) {
    std::unordered_map<std::int32_t, std::int32_t> next;
    for (const auto& [a, b] : edges) next[a] = b;
    for (const mesh::BoundaryPart& part : mesh.boundary_parts) {
      const std::size_t place = place_of(part.name);
      std::int32_t node = part.first;
      for (std::size_t step = 0; step < edges.size(); ++step) {
        const auto found = next.find(node);
        if (found == next.end()) break;
        _of[node] = place;
        node = found->second;
        if (node == part.last) break;
      }
    }
  }

  Key key(const Edge& edge, bool free) {
    const auto found = _of.find(edge[0]);
    return {found != _of.end() ? found->second : place_of("boundary"), free};
  }
  const std::string& operator[](std::size_t place) const { return _all[place]; }

 private:
  std::size_t place_of(const std::string& name) {
    const auto [entry, is_new] = _places.try_emplace(name, _all.size());
    if (is_new) _all.push_back(name);
    return entry->second;
  }

  std::vector<std::string> _all;
  std::map<std::string, std::size_t> _places;
  std::unordered_map<std::int32_t, std::size_t> _of;
};

Edge sorted(const Edge& edge) { return {std::min(edge[0], edge[1]), std::max(edge[0], edge[1])}; }

/// An edge of a subdomain by the nodes of the mesh.
Edge on_mesh(const ddm::Subdomain& subdomain, const Edge& local) {
  return {subdomain.node[at(local[0])], subdomain.node[at(local[1])]};
}

/// Fluxes of u on a triangle.
struct Through {
  std::array<double, 3> sides{};  ///< int T du/dn over the side from each corner to the next

  Through(const ddm::Subdomain& subdomain, std::size_t triangle, const std::vector<double>& u) {
    const std::vector<double>& xy = subdomain.part.xy;
    const std::int32_t* corner = &subdomain.part.triangles[3 * triangle];
    std::array<mesh::Point, 3> normal{};  // of the sides, as long as these
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = 2 * at(corner[k]), j = 2 * at(corner[(k + 1) % 3]);
      normal[k] = {xy[j + 1] - xy[i + 1], xy[i] - xy[j]};
    }
    const double doubled = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
    mesh::Point slope{};
    for (const std::size_t k : {1, 2})  // of differences: u may be large and its slope small
      for (const std::size_t d : {0, 1})
        slope[d] -= (u[at(corner[k])] - u[at(corner[0])]) * normal[(k + 1) % 3][d] / doubled;
    const auto [xx, xy_, yy] = subdomain.tension.matrix(triangle);
    for (std::size_t k = 0; k < 3; ++k)
      sides[k] = (xx * slope[0] + xy_ * slope[1]) * normal[k][0] +
                 (xy_ * slope[0] + yy * slope[1]) * normal[k][1];
  }
};

/// The bounding box of a row.
struct Box {
  mesh::Point low, high;

  explicit Box(const mesh::Point& point) : low(point), high(point) {}
  void add(const mesh::Point& point) {
    for (const std::size_t k : {0, 1}) {
      low[k] = std::min(low[k], point[k]);
      high[k] = std::max(high[k], point[k]);
    }
  }
};

}  // namespace

BoundaryForces::BoundaryForces(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition,
                               const ddm::NeumannBoundary& neumann)
    : _decomposition(decomposition), _local(decomposition.subdomains.size()) {
  std::vector<Edge> edges = mesh.dirichlet;
  for (std::size_t s = 0; s < _local.size(); ++s)
    for (const Edge& local : neumann.of(s).nodes)
      edges.push_back(on_mesh(decomposition.subdomains[s], local));
  Names names(mesh, edges);
  std::map<Key, Box> boxes;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Key key = names.key(edges[e], e >= mesh.dirichlet.size());
    for (const std::int32_t node : edges[e])
      boxes.try_emplace(key, mesh::position(mesh, node))
          .first->second.add(mesh::position(mesh, node));
  }
  std::map<Key, std::int32_t> rows;
  for (const auto& [key, box] : boxes) {
    rows[key] = static_cast<std::int32_t>(_rows.size());
    contact::BoundaryAnswer& row = _rows.emplace_back();
    row.name = names[key.first];
    row.free = key.second;
    row.x = box.low[0] + 0.5 * (box.high[0] - box.low[0]);
    row.y = box.low[1] + 0.5 * (box.high[1] - box.low[1]);
  }
  std::unordered_map<std::int32_t, std::map<std::int32_t, double>> lengths;  // of nodes, by row
  std::map<Edge, std::int32_t> held;  // rows of edges, their lower nodes first
  for (const Edge& edge : mesh.dirichlet) {
    const std::int32_t row = held[sorted(edge)] = rows.at(names.key(edge, false));
    for (const std::int32_t node : edge) lengths[node][row] += length_of(mesh, edge);
  }
  for (std::size_t s = 0; s < _local.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    Local& local = _local[s];
    const auto free = static_cast<std::int32_t>(subdomain.free());
    for (std::size_t i = subdomain.free(); i < subdomain.node.size(); ++i) {
      const auto& shares = lengths.at(subdomain.node[i]);
      double all = 0;
      for (const auto& [row, length] : shares) all += length;
      for (const auto& [row, length] : shares)
        local.held.push_back({static_cast<std::int32_t>(i), row, length / all});
    }
    for (const Edge& edge : neumann.of(s).nodes)
      for (const std::int32_t node : edge)
        local.ends.push_back({node, rows.at(names.key(on_mesh(subdomain, edge), true))});
    for (std::size_t t = 0; t < subdomain.part.triangle_count(); ++t) {
      const std::int32_t* corner = &subdomain.part.triangles[3 * t];
      if (std::none_of(corner, corner + 3, [free](std::int32_t i) { return i >= free; })) continue;
      local.triangles.push_back(static_cast<std::int32_t>(t));
      for (const std::int32_t k : {0, 1, 2}) {
        const auto found = held.find(sorted(on_mesh(subdomain, {corner[k], corner[(k + 1) % 3]})));
        if (found != held.end())
          local.edges.push_back({static_cast<std::int32_t>(t), k, found->second});
      }
    }
  }
}

std::vector<contact::BoundaryAnswer> BoundaryForces::of(const contact::Answer& answer,
                                                        const LoadOnTraces& load) const {
  std::vector<contact::BoundaryAnswer> rows = _rows;
  for (std::size_t s = 0; s < _local.size(); ++s) {
    const ddm::Subdomain& subdomain = _decomposition.subdomains[s];
    const Local& local = _local[s];
    const std::size_t free = subdomain.free();
    const auto add = [&](const Share& share, double force) {
      contact::BoundaryAnswer& row = rows[at(share.row)];
      const double own = share.part * force;
      row.resultant += own;
      row.moment_x += own * (subdomain.part.xy[2 * at(share.node)] - row.x);
      row.moment_y += own * (subdomain.part.xy[2 * at(share.node) + 1] - row.y);
    };
    std::vector<double> held(subdomain.dirichlet);
    for (std::size_t i = 0; i < held.size(); ++i)
      held[i] = -load.subdomains[s].on_dirichlet[static_cast<Eigen::Index>(i)];
    for (const std::int32_t t : local.triangles) {
      const Through through(subdomain, at(t), answer.fields[s].u);
      for (std::size_t k = 0; k < 3; ++k)
        if (const std::size_t i = at(subdomain.part.triangles[3 * at(t) + k]); i >= free)
          held[i - free] -= 0.5 * through.sides[(k + 1) % 3];
    }
    for (const HeldEdge& edge : local.edges) {
      const double own =
          0.5 * Through(subdomain, at(edge.triangle), answer.fields[s].u).sides[at(edge.side)];
      for (const std::int32_t k : {edge.side, (edge.side + 1) % 3}) {
        const std::int32_t node = subdomain.part.triangles[3 * at(edge.triangle) + at(k)];
        add({node, edge.row}, own);
        held[at(node) - free] -= own;
      }
    }
    for (const Share& share : local.held) add(share, held[at(share.node) - free]);
    if (load.parts.traction.empty()) continue;
    const std::vector<double>& given = load.parts.traction[s].load;
    for (std::size_t i = 0; i < given.size(); ++i) add(local.ends[i], given[i]);
  }
  return rows;
}

std::vector<Eigen::VectorXd> BoundaryForces::isolated(std::size_t row) const {
  std::vector<Eigen::VectorXd> weights;
  if (_rows[row].free) return weights;
  for (std::size_t s = 0; s < _local.size(); ++s) {
    const ddm::Subdomain& subdomain = _decomposition.subdomains[s];
    weights.emplace_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(subdomain.dirichlet)));
    for (const Share& share : _local[s].held) {
      if (at(share.row) != row) continue;
      if (share.part != 1) return {};
      weights.back()[share.node - static_cast<Eigen::Index>(subdomain.free())] = 1;
    }
  }
  return weights;
}

std::size_t BoundaryForces::bytes() const noexcept {
  std::size_t bytes = _rows.capacity() * sizeof(contact::BoundaryAnswer);
  for (const Local& local : _local)
    bytes += (local.held.capacity() + local.ends.capacity()) * sizeof(Share) +
             local.edges.capacity() * sizeof(HeldEdge) +
             local.triangles.capacity() * sizeof(std::int32_t);
  return bytes;
}

const BoundaryForces& MeshOperator::Parts::boundary_forces() const {
  return boundary.get([this] { return BoundaryForces(*mesh, decomposition, neumann); });
}

std::size_t MeshOperator::boundary_count() const { return _parts->boundary_forces().size(); }

void MeshOperator::find_boundary(const PreparedLoad& load, contact::Answer& answer) const {
  require_prepared(load, true);
  if (load._data->balanced) return;  // a row of a sweep, without parts
  answer.boundary = _parts->boundary_forces().of(answer, load._data->condensed);
}

}  // namespace anticrack::operators
