// SPDX-License-Identifier: GPL-3.0-or-later
//
// Algorithm 2 of the paper written out slowly and obviously, as the twin that the fast one in trace
// space is held against: whole fields on both subdomains, the three auxiliary problems of section 7
// (y_k is the same for every k) written as they stand. It shares with the server only the element
// matrices and load integrals of fem/, and makes its own numbering, factors, norms and projection.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstdint>
#include <utility>
#include <vector>

#include "fem/load.hpp"
#include "fem/triangulation.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::reference {

/// The increments of the criterion cancel (1e-5 of u where it is 1e-10), so the twin has digits to
/// spare: what differs is the fast one's rounding.
using Real = long double;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

struct Parameters {
  double theta = 2;
  double p = 1e5;
  bool lumped = true;  ///< interface mass; false: the paper's int1d
};

/// For a mesh with one interface between subdomain 0 (Omega_1, minus) and 1 (Omega_2, plus), glue
/// and one delaminated inclusion on it, u = 0 on the whole outer boundary.
class FullFieldUzawa {
 public:
  FullFieldUzawa(const mesh::Mesh& mesh, const fem::Force& force, Parameters parameters);

  /// u_{1,k}, u_{2,k}, A_k and the criterion from mu_k, then mu_{k+1}.
  void step();

  /// By node of the mesh; meaningless on nodes of the other subdomain.
  const Vector& u1() const { return _u1; }
  const Vector& u2() const { return _u2; }
  Real a() const { return _a; }
  Real criterion() const { return _criterion; }
  Real energy() const { return _energy; }
  /// mu_k the last step started from, by node of the mesh, 0 off the interface.
  const Vector& mu() const { return _mu; }

 private:
  using Sparse = Eigen::SparseMatrix<Real>;
  using Mask = std::vector<char>;

  /// -div grad u = rhs with u prescribed where `fixed`: a matrix with unit rows there.
  struct DirichletProblem {
    DirichletProblem(const Sparse& stiffness, const Mask& fixed_nodes);
    Vector solve(const Vector& rhs, const Vector& prescribed) const;

    Sparse stiffness;
    Mask fixed;
    Eigen::SimplicialLDLT<Sparse> factor;
  };

  Vector mass_times(const Vector& mu) const;
  Vector on_gamma(Vector values) const;  ///< 0 in the other nodes
  /// u_1 for a load on Omega_1.
  Vector solve_first(const Vector& load) const;
  /// u_2 and A for a load on Omega_2: w and y^0, b, c, A = -c/b, u_2 = w - (A y + y^0).
  std::pair<Vector, Real> solve_second(const Vector& load) const;

  Parameters _parameters;
  Mask _gamma;      // nodes of the inclusion, tips included
  Mask _crack;      // nodes strictly inside it
  Mask _interface;  // nodes of the interface that are not on the outer boundary
  Sparse _interface_mass;
  Sparse _k1, _k2;
  Vector _f1, _f2;
  DirichletProblem _problem1, _problem2, _problem2_gamma;
  Vector _y;  // -1 on gamma, harmonic
  Vector _u1, _u2, _mu, _next_mu;
  Real _a = 0, _criterion = 1, _energy = 0;
  int _k = 0;
};

}  // namespace anticrack::reference
