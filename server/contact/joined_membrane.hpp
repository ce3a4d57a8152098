// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/contact_problem.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_factor.hpp"
#include "fem/stiffness.hpp"

namespace anticrack::contact {

/// The matrices of a JoinedProblem: the whole membrane with one sparse factor, for interfaces too
/// long for dense matrices. Unknowns: x has the interior nodes of the subdomains one after another
/// and then q; d are the jumps and p the held values (ddm::Skeleton). S^ is applied by a solve with
/// the factor of A, or, if contacts are condensed, is what the factorisation leaves of D: contacts
/// come last in the elimination. Immutable after construction, thread-safe. Keeps a reference.
class JoinedMembrane {
 public:
  /// Throws errors::Error: numerical when A is not positive definite; cancelled. O(N log N) memory.
  JoinedMembrane(const TraceProblem& traces, bool condense_contacts, int threads);

  bool condenses_contacts() const noexcept { return _factor.trace() == contacts(); }
  /// S^, once, while the problem is made.
  Eigen::MatrixXd take_condensed() { return _factor.take_schur(); }

  const TraceProblem& traces() const noexcept { return _traces; }
  const ddm::Decomposition& decomposition() const noexcept { return _traces.decomposition(); }
  Eigen::Index size() const noexcept { return _a.rows(); }      ///< length of x
  Eigen::Index contacts() const noexcept { return _b.rows(); }  ///< length of d

  /// As ContactProblem::loads, but nothing is condensed: z_interior and g are the loads in the
  /// interior and trace nodes, less K_.D g_D.
  std::vector<ddm::CondensedLoad> loads(std::size_t subdomain,
                                        const Eigen::Ref<const Eigen::MatrixXd>& of_nodes,
                                        const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const;

  /// f in [x d p], from forces h on the skeleton's unknowns and the interior part of `loads`.
  Eigen::VectorXd spread(const Eigen::VectorXd& h,
                         std::span<const ddm::CondensedLoad> loads = {}) const;
  /// Eliminates x with every contact closed. `force`: in [x d p]. One solve, `refined`: two, the
  /// second of iterative refinement.
  Reduced reduce(const Eigen::VectorXd& force, const Eigen::VectorXd& p, bool refined) const;
  /// f_x - K_xp p. `force`: in [x d p].
  Eigen::VectorXd on_free(const Eigen::VectorXd& force, const Eigen::VectorXd& p) const;

  /// S^ d. One solve, or two with a step of iterative refinement.
  Eigen::VectorXd apply(const Eigen::VectorXd& d, bool refined = false) const;
  /// K [x d 0] in [x d p], summed from the forces on the nodes. The equation of an inclusion that
  /// moves is the sum over all its nodes, whose forces are far larger than their sum.
  Eigen::VectorXd forces_of(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const;
  /// x for forces on x and jumps d, column by column. Two solves, the second for the residual by
  /// forces_of.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& force, const Eigen::MatrixXd& d) const;
  /// The displacement of each sum under a unit force on it, every contact closed. Half a solve
  /// each.
  std::vector<double> compliances(std::span<const ddm::Terms* const> sums) const;
  /// A^-1 B'd, what jumps d take off x. One solve.
  Eigen::VectorXd of_jumps(const Eigen::VectorXd& d) const;
  /// [y p], f and K [y 0 p] of a load with every contact closed, all in [x p].
  Work work(const Eigen::VectorXd& force, const Reduced& reduced) const;

  /// u on the free nodes of a subdomain. `w`: the values of the skeleton.
  Eigen::VectorXd field(std::size_t subdomain, const Eigen::VectorXd& x,
                        const Eigen::VectorXd& w) const;
  /// u on the nodes of all subdomains, one after another, 0 on the Dirichlet boundary; p is 0.
  std::vector<double> field(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const;
  /// K u on the free nodes of a subdomain. O(N).
  Eigen::VectorXd forces(std::size_t subdomain, const Eigen::VectorXd& u) const;
  /// f - K u in [x d p]; the difference is formed in each node before it is summed. `loads` may be
  /// empty. O(N).
  Eigen::VectorXd residual(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& x,
                           const Eigen::VectorXd& w) const;

  /// The lower triangle of K in [x d p], and a place (x, y) in the plane for each entry of x and d.
  const Eigen::SparseMatrix<double>& matrix() const noexcept { return _matrix; }
  const std::vector<double>& places() const noexcept { return _places; }
  /// The lower triangle of K on [x d], and the order in which both are eliminated.
  Eigen::SparseMatrix<double> open() const;
  const std::vector<std::int32_t>& order() const noexcept { return _order; }
  /// B, by rows.
  const Eigen::SparseMatrix<double, Eigen::RowMajor>& coupling() const noexcept { return _b; }
  std::size_t bytes() const noexcept;

 private:
  Eigen::SparseMatrix<double> assemble();
  Eigen::VectorXd values(const Eigen::VectorXd& x, const Eigen::VectorXd& d) const;
  Eigen::MatrixXd solve_once(const Eigen::MatrixXd& force) const;
  Eigen::VectorXd solve_refined(const Eigen::VectorXd& force) const;

  const TraceProblem& _traces;
  std::vector<fem::Stiffness> _stiffness;  // per subdomain
  std::vector<Eigen::Index> _first;        // of each subdomain's interior in x
  Eigen::Index _interior = 0;              // number of interior nodes of all subdomains
  std::vector<double> _places;
  Eigen::SparseMatrix<double> _matrix;              // K; assemble() sets it and the members above
  Eigen::SparseMatrix<double> _a;                   // A, lower triangle
  Eigen::SparseMatrix<double, Eigen::RowMajor> _b;  // B
  Eigen::SparseMatrix<double> _d;                   // D, lower triangle
  Eigen::SparseMatrix<double> _xp, _dp, _pp;
  std::vector<std::int32_t> _order;  // of x and d; that of x alone is the same without d
  ddm::SubdomainFactor _factor;
};

}  // namespace anticrack::contact
