// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/monolithic_contact.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "mesh/at.hpp"

namespace anticrack::reference {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using mesh::Kind;

struct Sets {
  explicit Sets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
  std::int32_t find(std::int32_t i) {
    while (parent[at(i)] != i) {
      i = parent[at(i)] = parent[at(parent[at(i)])];
    }
    return i;
  }
  void unite(std::int32_t a, std::int32_t b) { parent[at(find(a))] = find(b); }
  std::vector<std::int32_t> parent;
};

using NodePairKey = std::pair<std::int32_t, std::int32_t>;

}  // namespace

MonolithicContact::MonolithicContact(const mesh::Mesh& mesh, const MonolithicLoad& load)
    : _mesh(mesh), _dirichlet(mesh.node_count(), 0) {
  for (const auto& edge : mesh.dirichlet) {
    _dirichlet[at(edge[0])] = _dirichlet[at(edge[1])] = 1;
  }
  find_edges();
  double_nodes();
  tie();
  solve(load);
}

/// The plus side of a-b is the triangle that has the edge in this direction, counterclockwise.
void MonolithicContact::find_edges() {
  std::map<NodePairKey, std::int32_t> corner_before;  // (a, b) -> corner of a
  for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      corner_before[{_mesh.triangles[3 * t + k], _mesh.triangles[3 * t + (k + 1) % 3]}] =
          static_cast<std::int32_t>(3 * t + k);
    }
  }
  const auto next = [](std::int32_t corner) { return corner / 3 * 3 + (corner % 3 + 1) % 3; };
  for (const mesh::Interface& interface : _mesh.interfaces) {
    auto& edges = _edges.emplace_back();
    edges.reserve(interface.nodes.size());
    for (std::size_t e = 0; e + 1 < interface.nodes.size(); ++e) {
      const std::int32_t a = interface.nodes[e], b = interface.nodes[e + 1];
      const std::int32_t plus = corner_before.at({a, b}), minus = corner_before.at({b, a});
      edges.push_back({a,
                       b,
                       interface.kind[e],
                       interface.inclusion[e],
                       std::hypot(_mesh.xy[2 * at(a)] - _mesh.xy[2 * at(b)],
                                  _mesh.xy[2 * at(a) + 1] - _mesh.xy[2 * at(b) + 1]),
                       {{plus, next(minus)}, {next(plus), minus}}});
    }
  }
}

/// Corners are one dof where triangles meet along an edge that is on no interface.
void MonolithicContact::double_nodes() {
  std::map<NodePairKey, char> cut;
  for (const auto& edges : _edges) {
    for (const Edge& edge : edges) {
      cut[std::minmax(edge.a, edge.b)] = 1;
    }
  }
  Sets corners(_mesh.triangles.size());
  std::map<NodePairKey, std::array<std::int32_t, 2>> first;  // of an edge, by its smaller node
  for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto here = static_cast<std::int32_t>(3 * t + k);
      auto there = static_cast<std::int32_t>(3 * t + (k + 1) % 3);
      if (_mesh.triangles[at(here)] > _mesh.triangles[at(there)]) {
        std::swap(here, there);
      }
      const NodePairKey key{_mesh.triangles[at(here)], _mesh.triangles[at(there)]};
      if (cut.count(key) != 0) {
        continue;
      }
      if (const auto found = first.find(key); found != first.end()) {
        corners.unite(here, found->second[0]);
        corners.unite(there, found->second[1]);
      } else {
        first[key] = {here, there};
      }
    }
  }
  std::map<std::int32_t, std::int32_t> number;
  _dof.reserve(_mesh.triangles.size());
  for (std::size_t i = 0; i < _mesh.triangles.size(); ++i) {
    const auto entry = number.try_emplace(corners.find(static_cast<std::int32_t>(i)), _dofs);
    _dofs += entry.second ? 1 : 0;
    _dof.push_back(entry.first->second);
  }
}

void MonolithicContact::tie() {
  const auto inclusions = static_cast<std::int32_t>(_mesh.inclusions.size());
  Sets equal(at(_dofs + inclusions));
  _rigid.assign(at(_dofs), 0);
  for (const auto& edges : _edges) {
    for (const Edge& edge : edges) {
      for (std::size_t end = 0; end < 2; ++end) {
        if (_dirichlet[at(end == 0 ? edge.a : edge.b)] != 0) {
          continue;
        }
        const std::int32_t plus = _dof[at(edge.end[end].plus)];
        const std::int32_t minus = _dof[at(edge.end[end].minus)];
        if (edge.kind == Kind::glue || edge.kind == Kind::inclusion) {
          equal.unite(plus, minus);
        }
        if (edge.inclusion >= 0) {
          equal.unite(plus, _dofs + edge.inclusion);
          _rigid[at(plus)] = 1;
        }
      }
    }
  }
  std::vector<char> prescribed(at(_dofs + inclusions), 0);
  for (std::size_t i = 0; i < _dof.size(); ++i) {
    prescribed[at(_dof[i])] |= _dirichlet[at(_mesh.triangles[i])];
  }
  std::map<std::int32_t, std::int32_t> number;
  for (std::int32_t i = 0; i < _dofs + inclusions; ++i) {
    if (prescribed[at(i)] != 0) {
      _unknown.push_back(-1);
      continue;
    }
    const auto entry = number.try_emplace(equal.find(i), _unknowns);
    _unknowns += entry.second ? 1 : 0;
    _unknown.push_back(entry.first->second);
  }
  for (const auto& edges : _edges) {
    for (const Edge& edge : edges) {
      for (const Ends& end : edge.end) {
        const std::int32_t upper = _unknown[at(_dof[at(end.plus)])];
        const std::int32_t lower = _unknown[at(_dof[at(end.minus)])];
        if ((edge.kind == Kind::crack || edge.kind == Kind::delaminated) && upper != lower) {
          _inequalities.push_back({upper, lower});
        }
      }
    }
  }
}

/// lambda >= 0 with gap + matrix lambda >= 0 and their product zero, by projected Gauss-Seidel.
VectorXd MonolithicContact::project(const Eigen::MatrixXd& matrix, const VectorXd& gap) {
  VectorXd lambda = VectorXd::Zero(gap.size());
  VectorXd slack = gap;
  constexpr int limit = 400'000;
  for (int sweep = 0; sweep < limit && !_converged; ++sweep) {
    if (sweep % 64 == 0) {
      slack = gap + matrix * lambda;  // forget the rounding of the updates
    }
    double change = 0;
    for (Index i = 0; i < gap.size(); ++i) {
      const double next = std::max(0.0, lambda[i] - slack[i] / matrix(i, i));
      const double step = next - lambda[i];
      if (step != 0) {
        slack += step * matrix.col(i);
        lambda[i] = next;
        change = std::max(change, std::abs(step));
      }
    }
    _converged = change <= 1e-14 * (1e-300 + lambda.sum());
  }
  return lambda;
}

void MonolithicContact::solve(const MonolithicLoad& load) {
  std::vector<Eigen::Triplet<double>> entries;
  VectorXd f = VectorXd::Zero(_dofs);
  _u = VectorXd::Zero(_dofs);
  for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
    double x[3], y[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t node = at(_mesh.triangles[3 * t + k]);
      x[k] = _mesh.xy[2 * node];
      y[k] = _mesh.xy[2 * node + 1];
      if (_dirichlet[node] != 0) {
        _u[_dof[3 * t + k]] = load.boundary(x[k], y[k]);
      }
    }
    const double area = ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])) / 2;
    const double tension = _mesh.tension.empty() ? 1 : _mesh.tension[at(_mesh.subdomain[t])];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      f[_dof[3 * t + i]] += load.force[t] * area / 3;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const double value =
            tension / (4 * area) *
            ((y[i1] - y[i2]) * (y[j1] - y[j2]) + (x[i2] - x[i1]) * (x[j2] - x[j1]));
        entries.emplace_back(_dof[3 * t + i], _dof[3 * t + j], value);
      }
    }
  }
  Eigen::SparseMatrix<double> k(_dofs, _dofs);
  k.setFromTriplets(entries.begin(), entries.end());

  std::vector<Eigen::Triplet<double>> expansion;
  for (std::int32_t i = 0; i < _dofs; ++i) {
    if (_unknown[at(i)] >= 0) {
      expansion.emplace_back(i, _unknown[at(i)], 1.0);
    }
  }
  Eigen::SparseMatrix<double> t(_dofs, _unknowns);
  t.setFromTriplets(expansion.begin(), expansion.end());
  VectorXd right = t.transpose() * (f - k * _u);
  for (std::size_t j = 0; j < load.inclusion_forces.size(); ++j) {
    right[_unknown[at(_dofs) + j]] += load.inclusion_forces[j];
  }
  const Eigen::SparseMatrix<double> reduced = t.transpose() * k * t;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(reduced);
  _held = factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 1e-10;
  if (!_held) {
    return;
  }
  _x = factor.solve(right);
  const auto count = static_cast<Index>(_inequalities.size());
  if (count > 0) {
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(_unknowns, count);
    for (Index i = 0; i < count; ++i) {
      b(_inequalities[at(i)].upper, i) = 1;
      b(_inequalities[at(i)].lower, i) = -1;
    }
    const Eigen::MatrixXd answers = factor.solve(b);
    const VectorXd lambda = project(b.transpose() * answers, b.transpose() * _x);
    _x = factor.solve(VectorXd(right + b * lambda));
    for (Index i = 0; i < count; ++i) {
      ++(lambda[i] > 0 ? _closed : _open);
    }
  } else {
    _converged = true;
  }
  _u += t * _x;
  _residual = k * _u - f;
  _energy = _u.dot(k * _u) / 2 - f.dot(_u);
  for (std::size_t j = 0; j < load.inclusion_forces.size(); ++j) {
    _energy -= load.inclusion_forces[j] * displacement(j);
  }
}

double MonolithicContact::u(std::size_t triangle, std::size_t corner) const {
  return _u[_dof[3 * triangle + corner]];
}

double MonolithicContact::u_side(std::size_t c, std::size_t e, std::size_t end, bool plus) const {
  const Ends& ends = _edges[c][e].end[end];
  return _u[_dof[at(plus ? ends.plus : ends.minus)]];
}

std::optional<double> MonolithicContact::multiplier(std::size_t c, std::size_t e,
                                                    std::size_t end) const {
  const Edge& edge = _edges[c][e];
  const std::int32_t node = end == 0 ? edge.a : edge.b;
  const std::int32_t plus = _dof[at(edge.end[end].plus)];
  const std::int32_t minus = _dof[at(edge.end[end].minus)];
  if (_dirichlet[at(node)] != 0 || plus == minus || _rigid[at(minus)] != 0) {
    return std::nullopt;
  }
  double mass = 0;
  for (const auto& edges : _edges) {
    for (const Edge& other : edges) {
      for (std::size_t k = 0; k < 2; ++k) {
        if ((k == 0 ? other.a : other.b) != node) {
          continue;
        }
        if (_dof[at(other.end[k].plus)] != plus || _dof[at(other.end[k].minus)] != minus) {
          return std::nullopt;
        }
        mass += other.length / 2;
      }
    }
  }
  return -_residual[minus] / mass;
}

double MonolithicContact::displacement(std::size_t inclusion) const {
  return _x[_unknown[at(_dofs) + inclusion]];
}

}  // namespace anticrack::reference
