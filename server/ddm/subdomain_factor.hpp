// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace anticrack::ddm {

/// How many columns of `rows` entries to solve together: at most 32 and 64 MiB, at least one.
Eigen::Index columns_at_once(Eigen::Index rows) noexcept;

/// Sparse Cholesky factor of the interior of one subdomain, with its interface numbered last:
///
///   K = [K_II K_IG; K_GI K_GG],  P K_II P' = L_II L_II',  L_GI = K_GI P' L_II'^-1,
///   S = K_GG - L_GI L_GI' = K_GG - K_GI K_II^-1 K_IG
///
/// S is the discrete Steklov-Poincare operator. P permutes interior unknowns only. K is singular if
/// a part of the subdomain floats; K_II is not, since each such part has interface nodes. Immutable
/// after construction, thread-safe.
class SubdomainFactor {
 public:
  /// K: symmetric positive semidefinite, interior unknowns first; its lower triangle is read.
  /// `order`: the order of elimination of the interior (elimination_order.hpp). Runs CHOLMOD's
  /// analysis, then the multifrontal method. Throws errors::Error: numerical if K_II is not
  /// positive definite, limit_exceeded if there is not enough memory.
  SubdomainFactor(const Eigen::SparseMatrix<double>& stiffness, Eigen::Index interior,
                  std::span<const std::int32_t> order, int threads = 1);
  ~SubdomainFactor();
  SubdomainFactor(SubdomainFactor&&) noexcept;
  SubdomainFactor& operator=(SubdomainFactor&&) noexcept;

  struct Forward {
    Eigen::VectorXd z_interior;  ///< L_II^-1 P f_I, in the factor's order
    Eigen::VectorXd g;           ///< condensed load f_G - K_GI K_II^-1 f_I
  };
  /// Eliminates the interior from each column of f. O(nnz(L)) each, up to 32 together; the bits of
  /// a column do not depend on the others.
  std::vector<Forward> forward(const Eigen::Ref<const Eigen::MatrixXd>& f) const;
  /// Writes the same into `result`, reusing its memory.
  void forward(const Eigen::Ref<const Eigen::MatrixXd>& f, std::vector<Forward>& result) const;

  struct Backward {
    const Eigen::VectorXd& z_interior;  ///< from forward()
    Eigen::Ref<const Eigen::VectorXd> trace;
    Eigen::Ref<Eigen::VectorXd> u;  ///< (interior + trace), overwritten
  };
  /// Computes u of each column, with trace t and interior K_II^-1 (f_I - K_IG t), f the load of
  /// `z_interior`: a backward solve of L_II' x = z_I - L_GI' t. O(nnz(L)) each, up to 32 together;
  /// the bits of a column do not depend on the others.
  void recover(std::span<Backward> columns) const;

  /// x <- K_II^-1 f on the interior, with 0 on the trace: forward() and recover() in one.
  void solve(const Eigen::Ref<const Eigen::MatrixXd>& f, Eigen::Ref<Eigen::MatrixXd> x) const;

  /// S t, O(n_G^2).
  Eigen::VectorXd apply_schur(const Eigen::VectorXd& trace) const;
  /// Writes the same into `result`, which must not overlap `trace`. No allocation.
  void apply_schur(const Eigen::Ref<const Eigen::VectorXd>& trace,
                   Eigen::Ref<Eigen::VectorXd> result) const;
  /// S, dense, symmetric to the bit.
  const Eigen::MatrixXd& schur() const noexcept { return _schur; }
  /// Takes S away; apply_schur() has nothing to apply then.
  Eigen::MatrixXd take_schur() { return std::move(_schur); }

  /// The number of interior and of trace nodes; the memory of the factor and S in bytes.
  Eigen::Index interior() const noexcept { return _interior; }
  Eigen::Index trace() const noexcept { return _trace; }
  std::size_t bytes() const noexcept;

 private:
  struct Factor;  // keeps CHOLMOD's types out of this header
  std::unique_ptr<const Factor> _factor;
  Eigen::Index _interior, _trace;
  Eigen::MatrixXd _schur;
};

}  // namespace anticrack::ddm
