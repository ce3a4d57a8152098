// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/monolithic_contact.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "base/at.hpp"

namespace anticrack::reference {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using mesh::Kind;

using Tensor = Eigen::Matrix2d;

/// A number, or a law of constants.
Tensor tension_of(const mesh::Mesh& mesh, std::size_t subdomain) {
  const double number = mesh.tension.empty() ? 1 : mesh.tension[subdomain];
  if (mesh.tension_laws.empty() || mesh.tension_laws[subdomain].along.empty())
    return number * Tensor::Identity();
  const mesh::TensionLaw& law = mesh.tension_laws[subdomain];
  const Tensor turn = Eigen::Rotation2Dd(law.angle * std::acos(-1.0) / 180).toRotationMatrix();
  return turn * Eigen::Vector2d(std::stod(law.along), std::stod(law.across)).asDiagonal() *
         turn.transpose();
}

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
  tie(load);
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

/// Conditions between the unknowns [dofs; A, Bx, By of each inclusion], a row and its value each.
class Conditions {
 public:
  explicit Conditions(Index unknowns) : _unknowns(unknowns) {}

  void require(const std::vector<std::pair<Index, double>>& terms, double value) {
    for (const auto& [column, factor] : terms) _entries.emplace_back(rows(), column, factor);
    _value.push_back(value);
  }
  Index rows() const { return static_cast<Index>(_value.size()); }
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows(), _unknowns);
    for (const auto& entry : _entries) result(entry.row(), entry.col()) += entry.value();
    return result;
  }
  VectorXd values() const { return Eigen::Map<const VectorXd>(_value.data(), rows()); }

 private:
  Index _unknowns;
  std::vector<Eigen::Triplet<double>> _entries;
  std::vector<double> _value;
};

/// Which inclusions are one rigid body, for they share nodes; where each has its middle.
void MonolithicContact::find_bodies() {
  const std::size_t count = _mesh.inclusions.size();
  Sets joined(count);
  std::map<std::int32_t, std::int32_t> at_node;
  std::vector<std::array<double, 4>> box(count, {1e300, -1e300, 1e300, -1e300});
  for (const auto& edges : _edges) {
    for (const Edge& edge : edges) {
      for (const std::int32_t node : {edge.a, edge.b}) {
        if (edge.inclusion < 0) continue;
        joined.unite(edge.inclusion, at_node.try_emplace(node, edge.inclusion).first->second);
        for (std::size_t k = 0; k < 2; ++k) {
          double* limits = &box[at(edge.inclusion)][2 * k];
          limits[0] = std::min(limits[0], _mesh.xy[2 * at(node) + k]);
          limits[1] = std::max(limits[1], _mesh.xy[2 * at(node) + k]);
        }
      }
    }
  }
  for (std::size_t j = 0; j < count; ++j) {
    _body.push_back(joined.find(static_cast<std::int32_t>(j)));
    _middle.push_back({(box[j][0] + box[j][1]) / 2, (box[j][2] + box[j][3]) / 2});
  }
}

/// Direction of a body whose nodes lie on a line, else (0, 0).
std::array<double, 2> MonolithicContact::direction(std::int32_t body) const {
  std::vector<std::array<double, 2>> points;
  for (const auto& edges : _edges)
    for (const Edge& edge : edges)
      for (const std::int32_t node : {edge.a, edge.b})
        if (edge.inclusion >= 0 && _body[at(edge.inclusion)] == body)
          points.push_back({_mesh.xy[2 * at(node)], _mesh.xy[2 * at(node) + 1]});
  std::array<double, 2> along{};
  for (const auto& p : points)
    if (std::hypot(p[0] - points[0][0], p[1] - points[0][1]) > std::hypot(along[0], along[1]))
      along = {p[0] - points[0][0], p[1] - points[0][1]};
  const double length = std::hypot(along[0], along[1]);
  for (const auto& p : points)
    if (std::abs(along[0] * (p[1] - points[0][1]) - along[1] * (p[0] - points[0][0])) >
        1e-9 * length * length)
      return {0, 0};
  return {along[0] / length, along[1] / length};
}

void MonolithicContact::tie(const MonolithicLoad& load) {
  find_bodies();
  const std::size_t inclusions = _mesh.inclusions.size();
  const Index unknowns = _dofs + static_cast<Index>(3 * inclusions);
  Conditions conditions(unknowns);
  const auto motion = [&](std::int32_t inclusion, std::int32_t node, double sign,
                          std::vector<std::pair<Index, double>>& terms) {
    const Index first = _dofs + 3 * Index{inclusion};
    const auto& middle = _middle[at(inclusion)];
    terms.emplace_back(first, sign);
    for (std::size_t k = 0; k < 2; ++k)
      terms.emplace_back(first + 1 + static_cast<Index>(k),
                         sign * (_mesh.xy[2 * at(node) + k] - middle[k]));
  };
  std::vector<char> known(at(_dofs), 0);
  for (std::size_t i = 0; i < _dof.size(); ++i) {
    const std::int32_t node = _mesh.triangles[i];
    if (_dirichlet[at(node)] == 0 || known[at(_dof[i])] != 0) continue;
    known[at(_dof[i])] = 1;
    conditions.require({{_dof[i], 1}},
                       load.boundary(_mesh.xy[2 * at(node)], _mesh.xy[2 * at(node) + 1]));
  }
  _rigid.assign(at(_dofs), 0);
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> of_body;  // (body, node)
  for (const auto& edges : _edges) {
    for (const Edge& edge : edges) {
      for (std::size_t end = 0; end < 2; ++end) {
        const std::int32_t node = end == 0 ? edge.a : edge.b;
        const std::int32_t plus = _dof[at(edge.end[end].plus)];
        const std::int32_t minus = _dof[at(edge.end[end].minus)];
        if (edge.kind == Kind::glue || edge.kind == Kind::inclusion)
          conditions.require({{plus, 1}, {minus, -1}}, 0);
        if (edge.inclusion < 0) continue;
        std::vector<std::pair<Index, double>> terms{{plus, 1}};
        motion(edge.inclusion, node, -1, terms);
        conditions.require(terms, 0);
        _rigid[at(plus)] = 1;
        const auto first = of_body.try_emplace({_body[at(edge.inclusion)], node}, edge.inclusion);
        if (first.first->second == edge.inclusion) continue;
        terms.clear();
        motion(edge.inclusion, node, 1, terms);
        motion(first.first->second, node, -1, terms);
        conditions.require(terms, 0);
      }
    }
  }
  for (std::size_t j = 0; j < inclusions; ++j) {
    const Index first = _dofs + static_cast<Index>(3 * j);
    const Index body = _dofs + 3 * Index{_body[j]};
    bool tilts = true;
    for (std::size_t i = 0; i < inclusions; ++i)
      tilts = tilts && (_body[i] != _body[j] || (!_mesh.motions.empty() && _mesh.motions[i].tilt));
    const std::array<double, 2> along = direction(_body[j]);
    for (Index k = 1; k < 3; ++k) {
      if (!tilts)
        conditions.require({{first + k, 1}}, 0);
      else if (first != body)
        conditions.require({{first + k, 1}, {body + k, -1}}, 0);
    }
    if (tilts && (along[0] != 0 || along[1] != 0))
      conditions.require({{first + 1, -along[1]}, {first + 2, along[0]}}, 0);
    if (!_mesh.motions.empty() && _mesh.motions[j].fixed)
      conditions.require({{first, 1}}, *_mesh.motions[j].fixed);
  }
  const Eigen::MatrixXd matrix = conditions.matrix();
  const VectorXd values = conditions.values();
  if (conditions.rows() == 0) {
    _particular = VectorXd::Zero(unknowns);
    _free = Eigen::MatrixXd::Identity(unknowns, unknowns);
  } else {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-10);
    solver.compute(matrix);
    _particular = solver.solve(values);
    _solvable = (matrix * _particular - values).norm() <= 1e-9 * (1 + values.norm());
    const Eigen::MatrixXd z = solver.matrixZ();
    _free = (solver.colsPermutation() * z.adjoint()).rightCols(unknowns - solver.rank());
  }
  for (const auto& edges : _edges) {
    for (const Edge& edge : edges) {
      for (const Ends& end : edge.end) {
        const std::int32_t upper = _dof[at(end.plus)], lower = _dof[at(end.minus)];
        if ((edge.kind == Kind::crack || edge.kind == Kind::delaminated) &&
            (_free.row(upper) - _free.row(lower)).norm() > 1e-10)
          _inequalities.push_back({upper, lower});
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
  for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
    double x[3], y[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t node = at(_mesh.triangles[3 * t + k]);
      x[k] = _mesh.xy[2 * node];
      y[k] = _mesh.xy[2 * node + 1];
    }
    const double area = ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])) / 2;
    const Tensor tension = tension_of(_mesh, at(_mesh.subdomain[t]));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      f[_dof[3 * t + i]] += load.force[t] * area / 3;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const Eigen::Vector2d of_i{y[i1] - y[i2], x[i2] - x[i1]},
            of_j{y[j1] - y[j2], x[j2] - x[j1]};
        const double value = of_i.dot(tension * of_j) / (4 * area);
        entries.emplace_back(_dof[3 * t + i], _dof[3 * t + j], value);
      }
    }
  }
  Eigen::SparseMatrix<double> k(_dofs, _dofs);
  k.setFromTriplets(entries.begin(), entries.end());
  // All unknowns are _particular + _free z.
  VectorXd work = VectorXd::Zero(_particular.size());
  work.head(_dofs) = f;
  for (std::size_t j = 0; j < load.inclusion_forces.size(); ++j)
    work[_dofs + static_cast<Index>(3 * j)] = load.inclusion_forces[j];
  for (std::size_t j = 0; j < load.inclusion_moments.size(); ++j)
    for (Index i = 0; i < 2; ++i)
      work[_dofs + static_cast<Index>(3 * j) + 1 + i] = load.inclusion_moments[j][at(i)];
  const Eigen::MatrixXd free = _free.topRows(_dofs);
  const Eigen::MatrixXd reduced = free.transpose() * (k * free);
  const Eigen::LDLT<Eigen::MatrixXd> factor(reduced);
  _held = factor.info() == Eigen::Success && factor.vectorD().minCoeff() > 1e-10;
  if (!_held || !_solvable) return;
  const VectorXd right =
      _free.transpose() * work - free.transpose() * (k * _particular.head(_dofs));
  VectorXd z = factor.solve(right);
  const auto count = static_cast<Index>(_inequalities.size());
  if (count > 0) {
    Eigen::MatrixXd b(z.size(), count);
    VectorXd gap(count);
    for (Index i = 0; i < count; ++i) {
      const auto [upper, lower] = _inequalities[at(i)];
      b.col(i) = (free.row(upper) - free.row(lower)).transpose();
      gap[i] = _particular[upper] - _particular[lower] + b.col(i).dot(z);
    }
    const Eigen::MatrixXd answers = factor.solve(b);
    const VectorXd lambda = project(b.transpose() * answers, gap);
    z = factor.solve(VectorXd(right + b * lambda));
    for (Index i = 0; i < count; ++i) ++(lambda[i] > 0 ? _closed : _open);
  } else {
    _converged = true;
  }
  _x = _particular + _free * z;
  _u = _x.head(_dofs);
  _residual = k * _u - f;
  _energy = _u.dot(k * _u) / 2 - work.dot(_x);
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
        mass += other.kind == Kind::free ? 0 : other.length / 2;
      }
    }
  }
  return mass > 0 ? std::optional(-_residual[minus] / mass) : std::nullopt;
}

double MonolithicContact::displacement(std::size_t inclusion) const {
  return _x[_dofs + static_cast<Index>(3 * inclusion)];
}

std::array<double, 2> MonolithicContact::slope(std::size_t inclusion) const {
  const Index first = _dofs + static_cast<Index>(3 * inclusion);
  return {_x[first + 1], _x[first + 2]};
}

}  // namespace anticrack::reference
