// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/dense_lcp.hpp"
#include "contact/nested_start.hpp"
#include "contact/trace_problem.hpp"
#include "ddm/lazy.hpp"

namespace anticrack::contact {

/// All subdomains joined at their traces and condensed to the cracks. With K = sum_i S_i over the
/// skeleton's unknowns w = Z q - P d + O p (Maps), load h = sum_i g_i - K O p:
///
///   H = Z'K Z,  C = Z'K P,  D = P'K P,  S^ = D - C'H^-1 C,  r = C'H^-1 Z'h - P'h
///   d >= 0,  lambda = S^ d - r >= 0,  d'lambda = 0;         q = H^-1 (Z'h + C d)
///
/// Immutable after construction, safe to share among threads. Keeps a reference to
/// its argument. Construction O(n^3) with n unknowns.
class SkeletonProblem {
 public:
  /// Throws errors::Error (numerical) when H is not positive definite.
  explicit SkeletonProblem(const TraceProblem& traces);

  /// One load, reduced.
  struct Reduced {
    Eigen::VectorXd q;          ///< H^-1 Z'h: the answer with every crack closed
    Eigen::VectorXd p;          ///< held values; empty: none
    Eigen::VectorXd r;          ///< per contact
    Eigen::VectorXd magnitude;  ///< sums of the absolute values r is made of
    double held_size = 0;       ///< largest force K O p of the held values
  };
  /// `h`: sum_i g_i; `p`: held values. O(n^2).
  Reduced reduce(const Eigen::VectorXd& h, const Eigen::VectorXd& p = {}) const;

  /// The same with a step of iterative refinement at d = 0, after which q and r are right to
  /// rounding of h. O(n^2).
  Reduced reduce_refined(const Eigen::VectorXd& h, const Eigen::VectorXd& p) const;

  /// K w. O(n_G^2).
  Eigen::VectorXd apply(const Eigen::VectorXd& w) const;
  /// What unit jumps of the contacts do to a sum of unknowns: it is that for d = 0 plus response'd.
  /// O(c) a term.
  Eigen::VectorXd response(const ddm::Terms& terms) const;
  /// w for jumps d, shape (unknowns). O(n c).
  Eigen::VectorXd unknowns(const Reduced& load, const Eigen::VectorXd& d) const;
  /// Adds to q of the load and to d what brings the residual h - K w to zero with d unchanged on
  /// the closed nodes: a step of iterative refinement. `open`: of the answer's open nodes. O(n^2).
  void refine(const Eigen::VectorXd& residual, const OpenFactor& open, Reduced& load,
              Eigen::VectorXd& d) const;
  /// P'(h - K w) of a residual, shape (d): lambda, which DenseLcp::split shares among dependent
  /// contacts. O(n).
  Eigen::VectorXd multipliers(const Eigen::VectorXd& residual) const;

  /// Sum over the subdomains of values on their traces, shape (unknowns).
  Eigen::VectorXd gather(const std::vector<Eigen::VectorXd>& on_traces) const;
  /// Values on the traces from those of the unknowns.
  std::vector<Eigen::VectorXd> scatter(const Eigen::VectorXd& w) const;

  const DenseLcp& lcp() const noexcept { return _lcp; }
  /// Of the lcp with every contact open; made at the first call, O(c^3).
  const OpenFactor& all_open() const;
  const NestedStart& nested_start() const noexcept { return _nested_start; }
  const TraceProblem& traces() const noexcept { return _traces; }
  /// Memory of the matrices.
  std::size_t bytes() const noexcept;

 private:
  struct Blocks;
  SkeletonProblem(const TraceProblem& traces, Blocks blocks);

  const Maps& maps() const noexcept { return _traces.maps(); }
  /// q <- H^-1 q.
  void solve_free(Eigen::VectorXd& q) const;

  const TraceProblem& _traces;
  Eigen::MatrixXd _h;               // Cholesky factor of H, lower triangle
  Eigen::MatrixXd _closed_to_open;  // W = H^-1 C
  NestedStart _nested_start;
  DenseLcp _lcp;
  ddm::Lazy<OpenFactor> _all_open;
};

}  // namespace anticrack::contact
