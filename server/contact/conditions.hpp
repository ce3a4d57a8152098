// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ddm/linear_conditions.hpp"

namespace anticrack::contact {

/// Conditions d >= 0 on the jumps of contacts and, where cracks cross, G d >= 0 on sums of jumps.
/// No two rows of G share a contact. Vectors over all conditions have the contacts first, then the
/// rows. The multiplier nu of a row is a part of lambda of its contacts; if all of these are
/// closed, nu is the value that makes the weighted sum of squares of all lambda least.
class Conditions {
 public:
  /// `rows`: G. `weights`: of each condition in the sum of squares; empty: all 1.
  Conditions(Eigen::Index contacts, std::vector<ddm::Terms> rows, Eigen::VectorXd weights);

  Eigen::Index contacts() const noexcept { return _contacts; }
  Eigen::Index size() const noexcept { return _weights.size(); }  ///< contacts and rows
  const std::vector<ddm::Terms>& rows() const noexcept { return _rows; }
  /// Index of row k among all conditions.
  Eigen::Index row(std::size_t k) const { return _contacts + static_cast<Eigen::Index>(k); }

  /// Whether any contact of row k is open.
  bool any_open(std::size_t k, const std::vector<char>& closed) const;
  /// Closes the rows whose contacts are all closed, as G d = 0 holds there anyway.
  void close_rows_without_open_contacts(std::vector<char>& closed) const;

  /// Sets the entries of the rows to G d; `jumps` has an entry per condition and begins with d.
  void add_rows(Eigen::VectorXd& jumps) const;
  /// Sets lambda of the rows to nu and takes G'nu off the contacts, where lambda was S d - r.
  void split(const std::vector<char>& closed, Eigen::VectorXd& lambda) const;
  /// The multiplier of row k with which the forces on its open contacts balance (least squares).
  double balancing(std::size_t k, const std::vector<char>& closed,
                   const Eigen::VectorXd& lambda) const;

  /// Jumps of all conditions from d; those of rows are 0 if closed and never negative.
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
