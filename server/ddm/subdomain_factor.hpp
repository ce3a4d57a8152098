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

/// Right-hand sides with `rows` entries to solve together: at least 1, at most 32 or 64 MiB.
Eigen::Index columns_at_once(Eigen::Index rows) noexcept;

/// Sparse Cholesky factor of the interior of one subdomain, with its interface numbered last:
///
///   K = [K_II K_IG; K_GI K_GG],  P K_II P' = L_II L_II',  L_GI = K_GI P' L_II'^-1,
///   S = K_GG - L_GI L_GI' = K_GG - K_GI K_II^-1 K_IG
///
/// S is the discrete Steklov-Poincare operator. P permutes interior unknowns only. K may be
/// singular where parts of the subdomain float; K_II is not, for each part has interface nodes.
/// Immutable after construction, thread-safe.
class SubdomainFactor {
 public:
  /// K: symmetric positive semidefinite, interior unknowns first; its lower triangle is read.
  /// `order`: of elimination of the interior (elimination_order.hpp). CHOLMOD's analysis, then the
  /// multifrontal method. Throws errors::Error (numerical if K_II is not positive definite,
  /// limit_exceeded without memory).
  SubdomainFactor(const Eigen::SparseMatrix<double>& stiffness, Eigen::Index interior,
                  std::span<const std::int32_t> order, int threads = 1);
  ~SubdomainFactor();
  SubdomainFactor(SubdomainFactor&&) noexcept;
  SubdomainFactor& operator=(SubdomainFactor&&) noexcept;

  struct Forward {
    Eigen::VectorXd z_interior;  ///< L_II^-1 P f_I, in the factor's order
    Eigen::VectorXd g;           ///< condensed load f_G - K_GI K_II^-1 f_I
  };
  /// For each column of f, O(nnz(L)), up to 32 together; its bits do not depend on the others.
  std::vector<Forward> forward(const Eigen::Ref<const Eigen::MatrixXd>& f) const;
  /// The same into `result`, reusing its memory.
  void forward(const Eigen::Ref<const Eigen::MatrixXd>& f, std::vector<Forward>& result) const;

  struct Backward {
    const Eigen::VectorXd& z_interior;  ///< of forward()
    Eigen::Ref<const Eigen::VectorXd> trace;
    Eigen::Ref<Eigen::VectorXd> u;  ///< (interior + trace), overwritten
  };
  /// For each column u with trace t and interior K_II^-1 (f_I - K_IG t), f the load of
  /// `z_interior`: a backward solve of L_II' x = z_I - L_GI' t, O(nnz(L)), up to 32 together; its
  /// bits do not depend on the others.
  void recover(std::span<Backward> columns) const;

  /// x <- K^-1 f without interface: both of the above.
  void solve(const Eigen::Ref<const Eigen::MatrixXd>& f, Eigen::Ref<Eigen::MatrixXd> x) const;

  /// S t, O(n_G^2).
  Eigen::VectorXd apply_schur(const Eigen::VectorXd& trace) const;
  /// The same into `result`, which does not overlap `trace`. No allocation.
  void apply_schur(const Eigen::Ref<const Eigen::VectorXd>& trace,
                   Eigen::Ref<Eigen::VectorXd> result) const;
  /// S, dense, symmetric to the bit.
  const Eigen::MatrixXd& schur() const noexcept { return _schur; }

  /// Numbers of free nodes; memory of the factor and S.
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
