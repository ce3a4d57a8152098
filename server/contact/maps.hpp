// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

#include "ddm/decomposition.hpp"

namespace anticrack::contact {

/// The skeleton's values as  w = Z q - P d + O p  (ddm::Skeleton): q free, rigid motions first, d
/// the jumps of the independent contacts, p held.
class Maps {
 public:
  /// Copies the terms of Z, P and O into sparse matrices. O(terms).
  explicit Maps(const ddm::Skeleton& skeleton);

  /// Lengths of w, q, d and p.
  Eigen::Index unknowns() const noexcept { return _free.rows(); }
  Eigen::Index free_count() const noexcept { return _free.cols(); }
  Eigen::Index jump_count() const noexcept { return _jumps.cols(); }
  Eigen::Index held_count() const noexcept { return _held.cols(); }

  const Eigen::SparseMatrix<double>& free() const noexcept { return _free; }    ///< Z
  const Eigen::SparseMatrix<double>& jumps() const noexcept { return _jumps; }  ///< P
  const Eigen::SparseMatrix<double>& held() const noexcept { return _held; }    ///< O

  /// w = Z q - P d + O p. O(n).
  Eigen::VectorXd expand(const Eigen::VectorXd& q, const Eigen::VectorXd& d,
                         const Eigen::VectorXd& p) const;
  /// The force on each unknown, shape (w), of a unit force on a sum of unknowns. O(n).
  Eigen::VectorXd vector_of(const ddm::Terms& sum) const;
  /// Memory of the three matrices in bytes.
  std::size_t bytes() const noexcept;

 private:
  Eigen::SparseMatrix<double> _free, _jumps, _held;
};

/// sum of factor * values[index].
double sum_of(const ddm::Terms& terms, const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace anticrack::contact
