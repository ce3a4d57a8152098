// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of the rows of a sweep, by products that all rows share.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "contact/sweep_columns.hpp"
#include "operators/shared_bounds.hpp"

namespace anticrack::operators {

/// Bounds of the rows of one chunk. For one thread.
class RowBounds {
 public:
  /// Keeps references.
  RowBounds(const MeshOperator::Parts& parts, const SharedBounds& shared);
  /// Fills the bounds of a row that `solution` solves. Leaves them out if they may be beyond the
  /// range of numbers or of rounding, or leave every cone: a load of its own tells more. No bit
  /// depends on other rows. O(b^2), and O(contacts^3) if the contact is not that of the last row.
  void find(std::span<const double> coefficients, const contact::LcpAnswer& solution,
            std::size_t row, contact::SweepColumns& rows);

 private:
  /// The pressure at the ends of faces, and how far the flux about their nodes is turned.
  struct Turned {
    Eigen::VectorXd ends, by;
  };
  /// z and tau of a goal: the jumps of z and of z', from which tau is made, and its forces.
  struct Pair {
    Eigen::VectorXd jumps, forces, reacting, shift;  ///< shift: z' - z; empty: 0
    Turned turned;                                   ///< of tau
    Eigen::VectorXd slope;  ///< int phi_k.(tau - T grad z) / T, before it is turned
    double square = 0;      ///< |tau - T grad z|^2
    double terms = 0;       ///< root of the sum of what may cancel in it
    double lack = 0;        ///< |t|
    double near = 0;        ///< >= |tau - T grad z|_omega
    double steep = 0;       ///< |z|_omega
    double largest = 0;     ///< max |z|
  };
  struct Goal {
    Pair pair;  ///< nothing clipped
    double compliance = 0;
  };
  /// A load with its solution.
  struct Row {
    Eigen::VectorXd y, sizes;                 ///< coefficients of u, and their absolute values
    Eigen::VectorXd forces, actual;           ///< lambda >= 0, and S^ d - r
    Eigen::VectorXd products, off_gradients;  ///< flux y; mixed y, if needed
    Turned turned;                            ///< of sigma
    Eigen::VectorXd slope;                    ///< int phi_k.(sigma - T grad u) / T, before
    double terms = 0;                         ///< as of a pair
    double norm_squared = 0, distance = 0, lack = 0, work = 0, pressure = 0;
    double oscillation = 0, reach = 0;  ///< |o|, and root of the sum of o^2 / omega
    double beyond = 0;                  ///< >= sum of o^2 + 2 o |sigma - T grad u|
  };

  bool take(std::span<const double> c, const contact::LcpAnswer& solution, double energy);
  bool aim(const std::vector<char>& closed);
  Pair pair(Eigen::Index goal, Eigen::VectorXd jumps, Eigen::VectorXd forces, bool clipped) const;
  double bound(Eigen::Index goal, double sign, double value);
  Eigen::VectorXd at_ends(const Eigen::VectorXd& forces) const;
  double work(const Eigen::VectorXd& ends, const Eigen::Ref<const Eigen::VectorXd>& jumps) const;
  Eigen::VectorXd slopes_of_work(const Eigen::Ref<const Eigen::VectorXd>& jumps) const;
  void turn(const Eigen::VectorXd& slope, const Eigen::VectorXd& least, const Eigen::VectorXd& most,
            Turned& turned) const;
  double turn_within(Eigen::Index goal, double sign, double most, Pair& pair) const;
  void finish(Eigen::Index goal, Pair& pair) const;

  const MeshOperator::Parts& _parts;
  const SharedBounds& _of;
  std::vector<Eigen::VectorXd> _unit;  // r of the goals
  Row _row;
  std::vector<char> _closed;
  std::vector<Goal> _goals;  // for _closed
  contact::AnswerSummary _summary;
};

}  // namespace anticrack::operators
