// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/full_field_uzawa.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "base/at.hpp"
#include "fem/load_vector.hpp"
#include "support/plain_stiffness.hpp"

namespace anticrack::reference {
namespace {

using Mask = std::vector<char>;

/// The triangles of one subdomain on the nodes of the whole mesh.
fem::Triangulation part(const mesh::Mesh& mesh, std::int32_t subdomain) {
  fem::Triangulation result;
  result.xy = mesh.xy;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.subdomain[t] == subdomain) {
      result.triangles.insert(result.triangles.end(), &mesh.triangles[3 * t],
                              &mesh.triangles[3 * t] + 3);
    }
  }
  return result;
}

/// Nodes where u_i is 0: the outer boundary, and all that do not belong to the subdomain.
Mask clamped(const mesh::Mesh& mesh, std::int32_t subdomain) {
  Mask mask(mesh.node_count(), 1);
  for (const std::int32_t node : part(mesh, subdomain).triangles) {
    mask[at(node)] = 0;
  }
  for (const auto& edge : mesh.dirichlet) {
    mask[at(edge[0])] = mask[at(edge[1])] = 1;
  }
  return mask;
}

Mask united(Mask a, const Mask& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = a[i] != 0 || b[i] != 0 ? 1 : 0;
  }
  return a;
}

Mask nodes_of_kind(const mesh::Mesh& mesh, mesh::Kind kind, bool only_inside) {
  Mask touched(mesh.node_count(), 0);
  for (const bool of_kind : {true, false}) {
    for (std::size_t e = 0; e < mesh.interfaces[0].kind.size(); ++e) {
      for (const std::int32_t node :
           {mesh.interfaces[0].nodes[e], mesh.interfaces[0].nodes[e + 1]}) {
        const bool same = mesh.interfaces[0].kind[e] == kind;
        if (of_kind && same) {
          touched[at(node)] = 1;
        } else if (!of_kind && only_inside && !same) {
          touched[at(node)] = 0;
        }
      }
    }
  }
  return touched;
}

}  // namespace

FullFieldUzawa::DirichletProblem::DirichletProblem(const Sparse& matrix, const Mask& fixed_nodes)
    : stiffness(matrix), fixed(fixed_nodes) {
  Sparse constrained = matrix;
  constrained.prune([this](Eigen::Index i, Eigen::Index j, double) {
    return fixed[static_cast<std::size_t>(i)] == 0 && fixed[static_cast<std::size_t>(j)] == 0;
  });
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i] != 0) {
      constrained.coeffRef(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = 1;
    }
  }
  factor.compute(constrained);
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("the reference could not factorise a subdomain");
  }
}

Vector FullFieldUzawa::DirichletProblem::solve(const Vector& rhs, const Vector& prescribed) const {
  Vector lift = Vector::Zero(rhs.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i] != 0) {
      lift[static_cast<Eigen::Index>(i)] = prescribed[static_cast<Eigen::Index>(i)];
    }
  }
  Vector right = rhs - stiffness * lift;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i] != 0) {
      right[static_cast<Eigen::Index>(i)] = lift[static_cast<Eigen::Index>(i)];
    }
  }
  return factor.solve(right);
}

FullFieldUzawa::FullFieldUzawa(const mesh::Mesh& mesh, const fem::Force& force,
                               Parameters parameters)
    : _parameters(parameters),
      _gamma(nodes_of_kind(mesh, mesh::Kind::delaminated, false)),
      _crack(nodes_of_kind(mesh, mesh::Kind::delaminated, true)),
      _interface(mesh.node_count(), 0),
      _k1(anticrack::testing::plain_stiffness(part(mesh, 0)).cast<Real>()),
      _k2(anticrack::testing::plain_stiffness(part(mesh, 1)).cast<Real>()),
      _f1(fem::load_vector(part(mesh, 0), force, mesh.subdomains[0]).cast<Real>()),
      _f2(fem::load_vector(part(mesh, 1), force, mesh.subdomains[1]).cast<Real>()),
      _problem1(_k1, clamped(mesh, 0)),
      _problem2(_k2, clamped(mesh, 1)),
      _problem2_gamma(_k2, united(clamped(mesh, 1), _gamma)) {
  const Mask outer = clamped(mesh, 1);
  for (const std::int32_t node : mesh.interfaces[0].nodes) {
    _interface[at(node)] = outer[at(node)] == 0 ? 1 : 0;
  }
  std::vector<Eigen::Triplet<Real>> entries;
  const auto& nodes = mesh.interfaces[0].nodes;
  for (std::size_t e = 0; e + 1 < nodes.size(); ++e) {
    const double length =
        std::hypot(mesh.xy[2 * at(nodes[e + 1])] - mesh.xy[2 * at(nodes[e])],
                   mesh.xy[2 * at(nodes[e + 1]) + 1] - mesh.xy[2 * at(nodes[e]) + 1]);
    for (const std::int32_t i : {nodes[e], nodes[e + 1]}) {
      for (const std::int32_t j : {nodes[e], nodes[e + 1]}) {
        const double consistent = i == j ? length / 3 : length / 6;
        entries.emplace_back(i, j, _parameters.lumped ? (i == j ? length / 2 : 0) : consistent);
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(mesh.node_count());
  _interface_mass.resize(n, n);
  _interface_mass.setFromTriplets(entries.begin(), entries.end());
  _u1 = _u2 = _mu = _next_mu = Vector::Zero(n);
  _y = _problem2_gamma.solve(Vector::Zero(n), on_gamma(Vector::Constant(n, -1)));
}

Vector FullFieldUzawa::mass_times(const Vector& mu) const { return _interface_mass * mu; }

Vector FullFieldUzawa::solve_first(const Vector& load) const {
  return _problem1.solve(load, Vector::Zero(load.size()));
}

std::pair<Vector, Real> FullFieldUzawa::solve_second(const Vector& load) const {
  const Vector zero = Vector::Zero(load.size());
  const Vector w = _problem2.solve(load, zero);
  const Vector y0 = _problem2_gamma.solve(zero, on_gamma(w));
  const Real b = -_y.dot(_k2 * _y);
  const Real c = -_y.dot(_k2 * y0);
  const Real a = -c / b;
  return {w - (a * _y + y0), a};
}

Vector FullFieldUzawa::on_gamma(Vector values) const {
  for (std::size_t i = 0; i < _gamma.size(); ++i) {
    if (_gamma[i] == 0) {
      values[static_cast<Eigen::Index>(i)] = 0;
    }
  }
  return values;
}

void FullFieldUzawa::step() {
  const Vector previous1 = _u1, previous2 = _u2;
  _mu = _next_mu;
  _u1 = solve_first(_f1 - mass_times(_mu));
  std::tie(_u2, _a) = solve_second(_f2 + mass_times(_mu));

  if (_k > 0) {
    const Vector d1 = _u1 - previous1, d2 = _u2 - previous2;
    _criterion =
        std::max(d1.dot(_k1 * d1) / _u1.dot(_k1 * _u1), d2.dot(_k2 * d2) / _u2.dot(_k2 * _u2));
  }
  _energy = _u1.dot(_k1 * _u1) / 2 - _f1.dot(_u1) + _u2.dot(_k2 * _u2) / 2 - _f2.dot(_u2);

  for (std::size_t i = 0; i < _interface.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (_interface[i] != 0) {
      const Real moved = _mu[k] + _parameters.theta * (_u1[k] - _u2[k]);
      const Real lowest = _crack[i] != 0 ? 0 : -Real(_parameters.p);
      _next_mu[k] = std::min(std::max(moved, lowest), Real(_parameters.p));
    }
  }
  ++_k;
}

}  // namespace anticrack::reference
