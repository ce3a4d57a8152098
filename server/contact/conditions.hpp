// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ddm/linear_conditions.hpp"

namespace anticrack::contact {

/// Conditions d >= 0 on the jumps of contacts and, where cracks cross, G d >= 0 on sums of them: a
/// row each, no two of which have terms in common. What is of all conditions has the contacts
/// first, then the rows. The multiplier nu of a row is a part of lambda of its contacts; where all
/// of them are closed it is the one that makes the weighted sum of squares of all lambda least.
class Conditions {
 public:
  /// `rows`: G. `weights`: of all conditions, in the sum of squares; empty: 1.
  Conditions(Eigen::Index contacts, std::vector<ddm::Terms> rows, Eigen::VectorXd weights);

  Eigen::Index contacts() const noexcept { return _contacts; }
  Eigen::Index size() const noexcept { return _weights.size(); }  ///< of all
  const std::vector<ddm::Terms>& rows() const noexcept { return _rows; }
  /// Number of a row among all.
  Eigen::Index row(std::size_t k) const { return _contacts + static_cast<Eigen::Index>(k); }

  /// Whether a contact of a row is open.
  bool any_open(std::size_t k, const std::vector<char>& closed) const;
  /// Those hold by themselves.
  void close_rows_without_open_contacts(std::vector<char>& closed) const;

  /// G d below d: of all conditions.
  void add_rows(Eigen::VectorXd& jumps) const;
  /// lambda of all conditions from S d - r in the contacts: what a row carries is taken off those.
  void split(const std::vector<char>& closed, Eigen::VectorXd& lambda) const;
  /// The multiplier of a row that leaves none on its open contacts.
  double balancing(std::size_t k, const std::vector<char>& closed,
                   const Eigen::VectorXd& lambda) const;

  /// Jumps of all conditions from d: rows 0 where closed, and not below.
  Eigen::VectorXd jumps(const Eigen::VectorXd& d, const std::vector<char>& closed) const;
  /// lambda of all conditions, 0 where open, from S d - r. O(c).
  Eigen::VectorXd multipliers(const Eigen::VectorXd& force, const std::vector<char>& closed) const;

 private:
  double least(std::size_t k, const Eigen::VectorXd& lambda) const;

  Eigen::Index _contacts;
  std::vector<ddm::Terms> _rows;
  Eigen::VectorXd _weights;
};

}  // namespace anticrack::contact
