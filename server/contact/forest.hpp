// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ddm/decomposition.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {

/// The skeleton's unknowns as w = Z q - P d: the contacts (edges) make a forest of the unknowns;
/// the smallest of each tree, an A_j where it has one, is its root and an entry of q, everything
/// else hangs below it on jumps:  w_plus = w_minus + d_c,  w_minus = w_plus - d_c.
class Forest {
 public:
  /// Throws errors::Error (internal) when the contacts are not a forest.
  explicit Forest(const ddm::Skeleton& skeleton);

  /// Lengths of w, q and d.
  Eigen::Index unknowns() const noexcept { return static_cast<Eigen::Index>(_root.size()); }
  Eigen::Index free_count() const noexcept { return static_cast<Eigen::Index>(_roots.size()); }
  Eigen::Index contact_count() const noexcept { return static_cast<Eigen::Index>(_hung.size()); }

  /// Root of each unknown's tree.
  std::int32_t root(std::int32_t unknown) const noexcept { return _root[at(unknown)]; }
  /// Unknowns that are roots, increasing: w of root k is q_k.
  const std::vector<Eigen::Index>& roots() const noexcept { return _roots; }
  /// The unknown that hangs on each contact.
  const std::vector<Eigen::Index>& hung() const noexcept { return _hung; }

  /// w = Z q - P d. O(n).
  Eigen::VectorXd expand(const Eigen::VectorXd& q, const Eigen::VectorXd& d) const;
  /// y_v <- sum of y over v and all below it, in the rows of y: then Z'y are the rows of the roots,
  /// and P'y those of the hung unknowns times `sign`. O(contacts * columns).
  void accumulate(Eigen::Ref<Eigen::MatrixXd> y) const;
  /// Per contact: +1 where the minus side hangs, -1 where the plus side does.
  const Eigen::VectorXd& sign() const noexcept { return _sign; }

 private:
  struct Hanging {
    Eigen::Index unknown, above, contact;
  };
  std::vector<std::int32_t> _root;
  std::vector<Eigen::Index> _roots, _hung;
  std::vector<Hanging> _downwards;  // each after the one it hangs on
  Eigen::VectorXd _sign;
};

}  // namespace anticrack::contact
