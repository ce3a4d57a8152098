// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/peers/monolithic.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace anticrack::benchmarks {
namespace {

enum class Role : char { free, dirichlet, contact, tied };

std::vector<Role> roles(const PlainMesh& mesh) {
  std::vector<Role> role(mesh.node_count(), Role::free);
  if (mesh.chains.size() != 1) throw std::runtime_error("the peers take one interface");
  const PlainMesh::Chain& chain = mesh.chains.front();
  for (std::size_t e = 0; e < chain.kind.size(); ++e) {
    if (chain.kind[e] == kind_glue) continue;
    if (chain.kind[e] != kind_delaminated || chain.inclusion[e] != 0) {
      throw std::runtime_error("the peers take glue and one delaminated inclusion");
    }
    for (const std::size_t end : {e, e + 1}) role[at(chain.nodes[end])] = Role::contact;
  }
  // A tip has glue on its other side and is tied.
  for (std::size_t e = 0; e < chain.kind.size(); ++e) {
    if (chain.kind[e] != kind_glue) continue;
    for (const std::size_t end : {e, e + 1}) {
      Role& r = role[at(chain.nodes[end])];
      if (r == Role::contact) r = Role::tied;
    }
  }
  for (const std::int32_t node : mesh.dirichlet) role[at(node)] = Role::dirichlet;
  return role;
}

/// The subdomain on the left of the chain.
std::int32_t plus_side(const PlainMesh& mesh) {
  const std::int32_t a = mesh.chains.front().nodes[0], b = mesh.chains.front().nodes[1];
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.triangles[3 * t + k] == a && mesh.triangles[3 * t + (k + 1) % 3] == b) {
        return mesh.subdomain[t];
      }
    }
  }
  throw std::runtime_error("nothing is on the plus side of the interface");
}

void number(const PlainMesh& mesh, Monolithic& system) {
  const std::vector<Role> role = roles(mesh);
  const auto count = [&role](Role which) {
    return static_cast<std::int32_t>(std::count(role.begin(), role.end(), which));
  };
  system.contacts = count(Role::contact);
  system.unknowns = count(Role::free) + system.contacts + 1;
  std::int32_t free = 0, contact = system.interior();
  std::vector<std::int32_t> of_node(role.size(), -1);
  for (std::size_t i = 0; i < role.size(); ++i) {
    if (role[i] == Role::free) of_node[i] = free++;
    if (role[i] == Role::contact) of_node[i] = contact++;
    if (role[i] == Role::tied) of_node[i] = system.unknowns - 1;
  }
  const std::int32_t plus = plus_side(mesh);
  system.corner.resize(mesh.triangles.size());
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t node = at(mesh.triangles[c]);
    const bool rigid = role[node] == Role::contact && mesh.subdomain[c / 3] == plus;
    system.corner[c] = rigid ? system.unknowns - 1 : of_node[node];
  }
}

/// u in a corner as at most two unknowns with their weights.
struct Parts {
  std::array<std::int32_t, 2> unknown{-1, -1};
  std::array<double, 2> weight{1, -1};
};

Parts parts(const Monolithic& system, std::size_t corner) {
  const std::int32_t unknown = system.corner[corner];
  const bool jump =
      system.minus == Minus::jumps && unknown >= system.interior() && unknown < system.unknowns - 1;
  Parts result;
  result.unknown = jump ? std::array<std::int32_t, 2>{system.unknowns - 1, unknown}
                        : std::array<std::int32_t, 2>{unknown, -1};
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
