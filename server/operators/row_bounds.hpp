// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the rows of a sweep, by products that all rows share.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/adjoint.hpp"
#include "contact/answer.hpp"
#include "contact/sweep_columns.hpp"
#include "estimate/interval.hpp"
#include "operators/shared_bounds.hpp"

namespace anticrack::operators {

/// Bounds of the rows of one chunk. For one thread.
class RowBounds {
 public:
  /// Keeps references; `loads`: the loads that `shared` is made of, reduced.
  RowBounds(const MeshOperator::Parts& parts, const SharedBounds& shared,
            const contact::SweepLoads& loads);
  /// Fills the bounds of a row that `solution` solves. Leaves them out if they may be beyond the
  /// range of numbers or of rounding, or leave every cone: a load of its own tells more. No bit
  /// depends on other rows. O(b^2), and O(contacts^3) if the contact is not that of the last row.
  void find(std::span<const double> coefficients, const contact::LcpAnswer& solution,
            std::size_t row, contact::SweepColumns& rows);

  /// z and tau of a goal: the jumps of z and of z', from which tau is made, and its pressure q.
  struct Pair {
    Eigen::VectorXd jumps, reacting, shift;  ///< shift: z' - z; empty: 0
    Eigen::VectorXd forces;                  ///< on the contacts, before q is turned
    FacePressures::Turned turned;            ///< q
    Eigen::VectorXd slope;  ///< int phi_k.(tau - T grad z) / T, before it is turned
    double square = 0;      ///< |tau - T grad z|^2
    double strain = 0;      ///< |z' - z|
    double terms = 0;       ///< root of the sum of what may cancel in it
    double lack = 0;        ///< |t|
    double near = 0;        ///< >= |tau - T grad z|_omega
    double steep = 0;       ///< |z|_omega
    double largest = 0;     ///< >= max |z|
  };
  /// A bound of A with the pair that gave it and the cone that it was tried in.
  struct Found {
    estimate::Bound bound;
    Pair pair;
    double most = 0;
  };
  /// Of the last row, to be compared with the fluxes themselves: the pressure of sigma, and the
  /// lower and the upper bound of each goal that moves.
  const FacePressures::Turned& pressure() const noexcept { return _row.turned; }
  const std::vector<Found>& found() const noexcept { return _found; }

 private:
  struct Goal {
    contact::Adjoint::Goal adjoint;
    Pair pair;  ///< nothing clipped
  };
  /// A load with its solution.
  struct Row {
    Eigen::VectorXd y, sizes;      ///< coefficients of u, and their absolute values
    Eigen::VectorXd reaction;      ///< S^ d - r
    Eigen::VectorXd forces, off;   ///< lambda >= 0, and |S^ d - r - lambda|
    Eigen::VectorXd divided;       ///< the pressure of `reaction`, not turned
    Eigen::VectorXd traction;      ///< SharedBounds::traction c
    Eigen::VectorXd products;      ///< flux y
    FacePressures::Turned turned;  ///< p
    Eigen::VectorXd slope;         ///< int phi_k.(sigma - T grad u) / T, before
    double terms = 0;              ///< as of a pair
    double norm_squared = 0, distance = 0, lack = 0, work = 0, pressure = 0;
    double unbalancing = 0;           ///< what sum y_b sigma_b lacks, a part of `lack`
    estimate::Unbalanced unbalanced;  ///< `dual`: root of the sum of o^2 / omega
  };

  bool take(std::span<const double> c, const contact::LcpAnswer& solution, double energy);
  bool aim(const std::vector<char>& closed);
  Pair pair(Eigen::Index goal, Eigen::VectorXd jumps, Eigen::VectorXd forces, bool clipped) const;
  Found bound(Eigen::Index goal, estimate::Side side, double value) const;
  estimate::Terms terms(Eigen::Index goal, double value, const Pair& z) const;
  double turn_within(Eigen::Index goal, double sign, double most, Pair& pair) const;
  void finish(Eigen::Index goal, Pair& pair) const;

  const MeshOperator::Parts& _parts;
  const SharedBounds& _of;
  const contact::SweepLoads& _loads;
  std::vector<Eigen::VectorXd> _unit;  // r of the goals
  Row _row;
  std::vector<char> _closed;
  std::vector<Goal> _goals;  // for _closed
  std::vector<Found> _found;
  contact::AnswerSummary _summary;
};

}  // namespace anticrack::operators
