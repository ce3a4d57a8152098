// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace anticrack::ddm {

/// How many right-hand sides with `rows` entries are solved together, at least one: enough for most
/// of what products of matrices gain over products with vectors, in at most 64 MiB.
Eigen::Index columns_at_once(Eigen::Index rows) noexcept;

/// Sparse Cholesky factor of the interior of one subdomain, with its interface numbered last:
///
///   K = [K_II K_IG; K_GI K_GG],  P K_II P' = L_II L_II',  L_GI = K_GI P' L_II'^-1,
///   S = K_GG - L_GI L_GI' = K_GG - K_GI K_II^-1 K_IG
///
/// The Schur complement S, the discrete Steklov-Poincare operator, is what the elimination of the
/// interior leaves of K_GG. P moves interior unknowns only. K may be singular, where parts of the
/// subdomain float: K_II is not, for each part has interface nodes.
/// Immutable after construction; any number of threads may solve with it at once.
class SubdomainFactor {
 public:
  /// K: symmetric positive semidefinite, interior unknowns first, its lower triangle is read;
  /// `order`: the interior unknowns in the order of their elimination (elimination_order.hpp).
  /// CHOLMOD's analysis, then the multifrontal method (multifrontal.hpp). Throws errors::Error
  /// (numerical when K_II is not positive definite, limit_exceeded without memory).
  SubdomainFactor(const Eigen::SparseMatrix<double>& stiffness, Eigen::Index interior,
                  std::span<const std::int32_t> order, int threads = 1);
  ~SubdomainFactor();
  SubdomainFactor(SubdomainFactor&&) noexcept;
  SubdomainFactor& operator=(SubdomainFactor&&) noexcept;

  struct Forward {
    Eigen::VectorXd z_interior;  ///< L_II^-1 P f_I, in the factor's order
    Eigen::VectorXd g;           ///< condensed load f_G - K_GI K_II^-1 f_I
  };
  /// Of each column of f. O(nnz(L)) each, up to 32 together (forward_solve.hpp). The bits of a
  /// column do not depend on the others.
  std::vector<Forward> forward(const Eigen::Ref<const Eigen::MatrixXd>& f) const;
  /// The same into `result`, in the memory that a former one has there.
  void forward(const Eigen::Ref<const Eigen::MatrixXd>& f, std::vector<Forward>& result) const;

  struct Backward {
    const Eigen::VectorXd& z_interior;  ///< of forward()
    Eigen::Ref<const Eigen::VectorXd> trace;
    Eigen::Ref<Eigen::VectorXd> u;  ///< (interior + trace), overwritten
  };
  /// Of each column u with trace t and interior K_II^-1 (f_I - K_IG t), f the load of `z_interior`:
  /// a backward solve of L_II' x = z_I - L_GI' t, O(nnz(L)) each, up to 32 together
  /// (backward_solve.hpp). The bits of a column do not depend on the others.
  void recover(std::span<Backward> columns) const;

  /// S t, O(n_G^2).
  Eigen::VectorXd apply_schur(const Eigen::VectorXd& trace) const;
  /// The same into `result`, of the size of `trace` and not part of it. No allocation.
  void apply_schur(const Eigen::Ref<const Eigen::VectorXd>& trace,
                   Eigen::Ref<Eigen::VectorXd> result) const;
  /// S, dense, symmetric to the bit.
  const Eigen::MatrixXd& schur() const noexcept { return _schur; }

  /// Free nodes inside and on the trace; memory of the factor and S.
  Eigen::Index interior() const noexcept { return _interior; }
  Eigen::Index trace() const noexcept { return _schur.rows(); }
  std::size_t bytes() const noexcept;

 private:
  struct Factor;  // keeps CHOLMOD's types out of this header
  std::unique_ptr<const Factor> _factor;
  Eigen::Index _interior;
  Eigen::MatrixXd _schur;
};

}  // namespace anticrack::ddm
