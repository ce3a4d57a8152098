// SPDX-License-Identifier: GPL-3.0-or-later
//
// Many load cases on one mesh for the numbers of their answers alone, without traces: what is
// linear in the load is done once, for a basis of loads.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "contact/contact_problem.hpp"
#include "contact/pair_forces.hpp"
#include "contact/solve.hpp"

namespace anticrack::contact {

/// What the rows of all sweeps on a mesh have in common.
struct SweepGeometry {
  explicit SweepGeometry(const TraceProblem& traces);

  /// Nodes of the interfaces that may open (interface, index of the node in it), and the contact
  /// condition of each: one is there twice where interfaces cross.
  std::vector<std::array<std::int32_t, 2>> nodes;
  std::vector<std::int32_t> contact;
  Eigen::VectorXd length;  ///< of each contact: lumped mass of its pairs
  /// Pairs of cross points that are closed where several contacts are.
  struct Implied {
    std::vector<std::int32_t> path;  ///< those contacts
    double length = 0;
  };
  std::vector<Implied> implied;

  /// Memory of its arrays.
  std::size_t bytes() const noexcept;
};

/// Loads with every contact closed, a column each. Of a combination sum_j c_j f_j all but the
/// energy are linear in c, and that is c' energy c. Where numbers hold inclusions they are a load
/// of their own, the last column, and every row has it once.
struct SweepLoads {
  Eigen::MatrixXd r, magnitude;  ///< (contacts, loads), as in Reduced
  Eigen::MatrixXd motion;        ///< (motions, loads)
  Eigen::MatrixXd energy;        ///< (loads, loads), symmetric: Pi

  /// Memory of its arrays.
  std::size_t bytes() const noexcept;
};

/// `constants`: (loads, loads), the part of the energy that the traces do not change (sum over the
/// subdomains of ddm::LoadProducts::energy; of one load: of energy_constant). O(n^2) a load; where
/// the membrane is joined two solves.
SweepLoads reduce(const ContactProblem& problem, std::span<const CaseLoads> loads,
                  const Eigen::MatrixXd& constants);

/// Solves row after row, each from the contact of the one before. A row's numbers are those of
/// solve_active_set for the same load, to rounding, and do not depend on the rows before. No
/// allocation in a row but as LcpSequence says. One object belongs to one thread. Keeps references
/// to what it is made of.
///   Pi = Pi(closed) - r'd/2                          (from d'lambda = 0)
///   A  = A(closed) + what the jumps do, and so the slopes
///   kkt: LcpAnswer::residual, the largest |lambda - (S^ d - r)| relative to the largest force on
///   the
///        contacts, of all the loads that are summed, with d and lambda clipped at 0 and one of
///        them 0 in each: what is wrong with equilibrium, gap, sign or complementarity of the
///        contacts is in it. The nodes between are in equilibrium by elimination, to rounding; it
///        is not measured row by row.
class SweepSolver {
 public:
  /// `start`: closed contacts; empty: all.
  SweepSolver(const ContactProblem& problem, const SweepGeometry& geometry,
              const ActiveSetOptions& options, std::span<const char> start);

  /// Writes one row. Ends not_converged, with zeros, where max_steps is reached, where a part that
  /// only contact holds is pulled off, and where a number is beyond the range of double.
  void solve(const SweepLoads& loads, std::span<const double> coefficients, std::size_t row,
             SweepColumns& rows);

  const std::vector<char>& closed() const noexcept { return _contact->answer().closed; }

 private:
  bool combine(const SweepLoads& loads, std::span<const double> coefficients);
  bool write(std::size_t row, SweepColumns& rows);

  const SweepGeometry& _geometry;
  const PairForces& _forces;
  std::unique_ptr<RowContact> _contact;
  std::vector<char> _pressed;
  Eigen::VectorXd _coefficients, _sizes, _r, _magnitude, _motion, _of_jumps, _product;
  double _energy = 0;
};

}  // namespace anticrack::contact
