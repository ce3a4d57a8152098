// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <span>
#include <vector>

#include "contact/solve.hpp"
#include "contact/trace_state.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_factor.hpp"
#include "ddm/subdomain_operator.hpp"
#include "fem/stiffness.hpp"

namespace anticrack::contact {

/// The whole membrane with one sparse factor, for interfaces too long for dense matrices. Unknowns:
/// x, the interior nodes of the subdomains one after another and then q; d the jumps, p what is
/// held (ddm::Skeleton). With K the stiffness of all subdomains in [x d p] and F the loads:
///
///   K = [A  B' .; B  D  .; . . .],   A x + B'd + K_xp p = F_x
///   S^ = D - B A^-1 B',   r = F_d - K_dp p - B y,   y = A^-1 (F_x - K_xp p)
///   d >= 0,  lambda = S^ d - r >= 0,  d'lambda = 0;     x = y - A^-1 B'd
///
/// S^ is never formed: it is applied by a solve with the factor of A. Immutable after construction,
/// thread-safe. Keeps a reference to the decomposition.
class JoinedMembrane {
 public:
  /// Throws errors::Error (numerical) when A is not positive definite; cancelled. O(N log N)
  /// memory.
  JoinedMembrane(const ddm::Decomposition& decomposition, int threads);

  const ddm::Decomposition& decomposition() const noexcept { return _decomposition; }
  Eigen::Index size() const noexcept { return _a.rows(); }      ///< of x
  Eigen::Index contacts() const noexcept { return _b.rows(); }  ///< of d

  /// Loads of a subdomain, a column each, as CondensedLoad that condenses nothing: z_interior and g
  /// are F in the interior and trace nodes, less what g_D takes. `of_nodes`, `dirichlet`: as for
  /// ddm::SubdomainOperator::condense. O(N).
  std::vector<ddm::CondensedLoad> loads(std::size_t subdomain,
                                        const Eigen::Ref<const Eigen::MatrixXd>& of_nodes,
                                        const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const;

  /// Nothing on any subdomain.
  std::vector<ddm::CondensedLoad> no_loads() const;

  /// A load with every contact closed.
  struct Reduced {
    Eigen::VectorXd force;      ///< F_x - K_xp p
    Eigen::VectorXd p;          ///< held values
    Eigen::VectorXd x;          ///< y
    Eigen::VectorXd r;          ///< per contact
    Eigen::VectorXd magnitude;  ///< sums of the absolute values r is made of
  };
  /// Two solves: one of iterative refinement. `p`: see held_values.
  Reduced reduce(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& p) const;

  /// F in [x d p] of a unit force on a sum of unknowns.
  Eigen::VectorXd gather(const ddm::Terms& unit) const;
  /// Of such a force.
  Reduced reduce(const ddm::Terms& unit) const;
  /// Its force and p alone, which solve() and values() need.
  Reduced force_of(const ddm::Terms& unit) const;

  /// S^ d. One solve, or two with a step of iterative refinement.
  Eigen::VectorXd apply(const Eigen::VectorXd& d, bool refined = false) const;
  /// K [x d 0] in [x d p] from the forces on the nodes. The equation of an inclusion that moves
  /// sums those of all its nodes, far larger than what is left of them.
  Eigen::VectorXd forces_of(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const;
  /// x for jumps d. Two solves: the residual is that of forces_of.
  Eigen::VectorXd solve(const Reduced& load, const Eigen::VectorXd& d) const;

  /// w of the skeleton.
  Eigen::VectorXd values(const Reduced& load, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& d) const;
  /// The same where p is 0.
  Eigen::VectorXd values(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const;
  /// u on the free nodes of a subdomain.
  Eigen::VectorXd field(std::size_t subdomain, const Eigen::VectorXd& x,
                        const Eigen::VectorXd& w) const;
  /// u on the nodes of all, one after another, 0 on the Dirichlet boundary.
  std::vector<double> field(const Eigen::VectorXd& x, const Eigen::VectorXd& w) const;
  /// Loads less the forces K u on the nodes. O(N).
  std::vector<ddm::CondensedLoad> residual(std::span<const ddm::CondensedLoad> loads,
                                           const Eigen::VectorXd& x,
                                           const Eigen::VectorXd& w) const;
  /// Traces, fluxes and the energy of the interiors.
  void fill(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& x,
            const Eigen::VectorXd& w, TraceState& state) const;
  /// lambda before DenseLcp::split, from fluxes. O(n).
  Eigen::VectorXd multipliers(const TraceState& state) const;
  /// a'K b of two loads with every contact closed.
  double work(const Reduced& a, const Reduced& b) const;
  /// F'u of a load on the closed state of another.
  double work(std::span<const ddm::CondensedLoad> loads, const Reduced& closed) const;

  /// K in [x d p], lower triangle, and a place in the plane for each entry of x and d.
  const Eigen::SparseMatrix<double>& matrix() const noexcept { return _matrix; }
  const std::vector<double>& places() const noexcept { return _places; }
  /// B, by rows.
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& coupling() const noexcept { return _b; }
  std::size_t bytes() const noexcept;

 private:
  Eigen::SparseMatrix<double> assemble();
  Eigen::VectorXd forces(std::size_t subdomain, const Eigen::VectorXd& u) const;
  Eigen::VectorXd gather(std::span<const ddm::CondensedLoad> loads) const;
  Eigen::VectorXd spread(const Eigen::VectorXd& on_values) const;
  Reduced reduce(const Eigen::VectorXd& force, const Eigen::VectorXd& p) const;
  Eigen::VectorXd solve_once(const Eigen::VectorXd& force) const;
  Eigen::VectorXd solve_refined(const Eigen::VectorXd& force) const;

  const ddm::Decomposition& _decomposition;
  std::vector<fem::Stiffness> _stiffness;  // per subdomain
  std::vector<Eigen::Index> _first;        // of each subdomain's interior in x
  Eigen::Index _interior = 0;              // interior nodes of all
  std::vector<double> _places;
  Eigen::SparseMatrix<double> _matrix;              // assemble() sets what is above as well
  Eigen::SparseMatrix<double> _a;                   // A, lower triangle
  Eigen::SparseMatrix<double, Eigen::RowMajor> _b;  // B
  Eigen::SparseMatrix<double> _d;                   // D, lower triangle
  Eigen::SparseMatrix<double> _xp, _dp, _pp;
  ddm::SubdomainFactor _factor;
};

}  // namespace anticrack::contact
