// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/peers/monolithic.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace anticrack::benchmarks {
namespace {

using Edge = std::pair<std::int32_t, std::int32_t>;

/// The corner at `a` of the triangle that has a -> b, counterclockwise.
std::map<Edge, std::size_t> corners_before(const PlainMesh& mesh) {
  std::map<Edge, std::size_t> result;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t next = c / 3 * 3 + (c % 3 + 1) % 3;
    result[{mesh.triangles[c], mesh.triangles[next]}] = c;
  }
  return result;
}

/// What the delaminated inclusions make of the nodes.
struct Slits {
  std::vector<std::int32_t> inclusion;  ///< (nodes) whose node it is, or -1
  std::vector<char> tip;                ///< (nodes)
  std::vector<char> rigid;              ///< (corners) on the plus side
  std::int32_t inclusions = 0;
};

/// Walks around each node of a slit from the corners left of its edges, as far as no slit is
/// crossed.
Slits find_slits(const PlainMesh& mesh) {
  Slits slits{std::vector<std::int32_t>(mesh.node_count(), -1),
              std::vector<char>(mesh.node_count(), 0), std::vector<char>(mesh.triangles.size(), 0),
              0};
  std::vector<int> edges(mesh.node_count(), 0);
  std::set<Edge> slit;
  for (const PlainMesh::Chain& chain : mesh.chains) {
    for (std::size_t e = 0; e < chain.kind.size(); ++e) {
      if (chain.kind[e] == kind_glue) continue;
      if (chain.kind[e] != kind_delaminated)
        throw std::runtime_error("the peers take glue and delaminated inclusions");
      for (const std::size_t end : {e, e + 1}) {
        slits.inclusion[at(chain.nodes[end])] = chain.inclusion[e];
        ++edges[at(chain.nodes[end])];
      }
      slits.inclusions = std::max(slits.inclusions, chain.inclusion[e] + 1);
      slit.insert({chain.nodes[e], chain.nodes[e + 1]});
    }
  }
  for (std::size_t i = 0; i < edges.size(); ++i) slits.tip[i] = edges[i] == 1 ? 1 : 0;
  const std::map<Edge, std::size_t> before = corners_before(mesh);
  const auto cut = [&slit](std::int32_t a, std::int32_t b) {
    return slit.count({a, b}) != 0 || slit.count({b, a}) != 0;
  };
  for (const auto& [a, b] : slit) {
    // Counterclockwise about a, from the triangle on the left of a -> b.
    for (std::size_t corner = before.at({a, b});;) {
      slits.rigid[corner] = 1;
      const std::int32_t third = mesh.triangles[corner / 3 * 3 + (corner % 3 + 2) % 3];
      const auto next = before.find({a, third});
      if (cut(a, third) || next == before.end()) break;
      corner = next->second;
    }
    // Clockwise about b, from the same triangle.
    for (std::size_t corner = before.at({a, b}) / 3 * 3 + (before.at({a, b}) % 3 + 1) % 3;;) {
      slits.rigid[corner] = 1;
      const std::int32_t third = mesh.triangles[corner / 3 * 3 + (corner % 3 + 1) % 3];
      const auto next = before.find({third, b});
      if (cut(b, third) || next == before.end()) break;
      corner = next->second / 3 * 3 + (next->second % 3 + 1) % 3;
    }
  }
  return slits;
}

void number(const PlainMesh& mesh, Monolithic& system) {
  const Slits slits = find_slits(mesh);
  std::vector<char> fixed(mesh.node_count(), 0);
  for (const std::int32_t node : mesh.dirichlet) fixed[at(node)] = 1;
  const auto contact = [&](std::size_t i) { return slits.inclusion[i] >= 0 && slits.tip[i] == 0; };
  system.inclusions = slits.inclusions;
  std::int32_t free = 0;
  std::vector<std::int32_t> of_node(mesh.node_count(), -1);
  for (std::size_t i = 0; i < of_node.size(); ++i)
    if (fixed[i] == 0 && slits.inclusion[i] < 0) of_node[i] = free++;
  for (std::size_t i = 0; i < of_node.size(); ++i) {
    if (!contact(i)) continue;
    of_node[i] = free + system.contacts++;
    system.above.push_back(slits.inclusion[i]);
  }
  system.unknowns = free + system.contacts + system.inclusions;
  system.corner.resize(mesh.triangles.size());
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t node = at(mesh.triangles[c]);
    const bool rigid = slits.inclusion[node] >= 0 && (slits.tip[node] != 0 || slits.rigid[c] != 0);
    system.corner[c] = rigid ? system.displacement(slits.inclusion[node]) : of_node[node];
  }
}

/// u in a corner as at most two unknowns with their weights.
struct Parts {
  std::array<std::int32_t, 2> unknown{-1, -1};
  std::array<double, 2> weight{1, -1};
};

Parts parts(const Monolithic& system, std::size_t corner) {
  const std::int32_t unknown = system.corner[corner];
  const std::int32_t contact = unknown - system.interior();
  Parts result;
  if (system.minus == Minus::jumps && contact >= 0 && contact < system.contacts)
    result.unknown = {system.displacement(system.above[at(contact)]), unknown};
  else
    result.unknown = {unknown, -1};
  return result;
}

using Matrix3 = std::array<std::array<double, 3>, 3>;

Matrix3 stiffness(const PlainMesh& mesh, std::size_t t) {
  std::array<double, 3> x{}, y{}, bx{}, by{};
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = mesh.xy[2 * at(mesh.triangles[3 * t + k])];
    y[k] = mesh.xy[2 * at(mesh.triangles[3 * t + k]) + 1];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    bx[k] = y[(k + 1) % 3] - y[(k + 2) % 3];
    by[k] = x[(k + 2) % 3] - x[(k + 1) % 3];
  }
  const double scale = 0.5 / (by[2] * bx[1] - bx[2] * by[1]);
  Matrix3 k{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) k[i][j] = scale * (bx[i] * bx[j] + by[i] * by[j]);
  }
  return k;
}

/// Calls `add(row, column, value)` for everything that comes into the upper triangle.
template <class Add>
void contributions(const PlainMesh& mesh, const Monolithic& system, Add&& add) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Matrix3 k = stiffness(mesh, t);
    std::array<Parts, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) corner[i] = parts(system, 3 * t + i);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t p = 0; p < 2; ++p) {
          for (std::size_t q = 0; q < 2; ++q) {
            const std::int32_t row = corner[i].unknown[p], column = corner[j].unknown[q];
            if (row < 0 || column < row) continue;
            add(row, column, corner[i].weight[p] * corner[j].weight[q] * k[i][j]);
          }
        }
      }
    }
  }
}

/// Sorts what came into each row and adds up what came twice.
void compress(Monolithic& system) {
  std::size_t out = 0, begin = 0;
  std::vector<std::pair<std::int32_t, double>> row;
  for (std::size_t r = 0; r < at(system.unknowns); ++r) {
    row.clear();
    const std::size_t end = at(system.first[r + 1]);
    for (std::size_t k = begin; k < end; ++k) row.emplace_back(system.column[k], system.value[k]);
    std::sort(row.begin(), row.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::size_t start = out;
    for (const auto& [column, value] : row) {
      if (out > start && system.column[out - 1] == column) {
        system.value[out - 1] += value;
      } else {
        system.column[out] = column;
        system.value[out++] = value;
      }
    }
    begin = end;
    system.first[r + 1] = static_cast<std::int32_t>(out);
  }
  system.column.resize(out);
  system.value.resize(out);
}

}  // namespace

Monolithic assemble(const PlainMesh& mesh, Minus minus) {
  Monolithic system;
  system.minus = minus;
  number(mesh, system);
  system.first.assign(at(system.unknowns) + 1, 0);
  contributions(mesh, system,
                [&system](std::int32_t row, std::int32_t, double) { ++system.first[at(row) + 1]; });
  for (std::size_t r = 0; r < at(system.unknowns); ++r) system.first[r + 1] += system.first[r];
  system.column.resize(at(system.first.back()));
  system.value.resize(at(system.first.back()));
  std::vector<std::int32_t> next(system.first.begin(), system.first.end() - 1);
  contributions(mesh, system, [&](std::int32_t row, std::int32_t column, double value) {
    const std::size_t k = at(next[at(row)]++);
    system.column[k] = column;
    system.value[k] = value;
  });
  compress(system);
  return system;
}

std::vector<double> load_vector(const PlainMesh& mesh, const Monolithic& system,
                                const std::vector<double>& nodal_force) {
  std::vector<double> load(at(system.unknowns), 0.0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<std::size_t, 3> node{};
    for (std::size_t k = 0; k < 3; ++k) node[k] = at(mesh.triangles[3 * t + k]);
    const auto x = [&](std::size_t k) { return mesh.xy[2 * node[k]]; };
    const auto y = [&](std::size_t k) { return mesh.xy[2 * node[k] + 1]; };
    const double area = 0.5 * ((x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0)));
    const double sum = nodal_force[node[0]] + nodal_force[node[1]] + nodal_force[node[2]];
    for (std::size_t k = 0; k < 3; ++k) {
      const Parts to = parts(system, 3 * t + k);
      for (std::size_t p = 0; p < 2; ++p) {
        if (to.unknown[p] < 0) continue;
        load[at(to.unknown[p])] += to.weight[p] * area / 12 * (sum + nodal_force[node[k]]);
      }
    }
  }
  return load;
}

}  // namespace anticrack::benchmarks
