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
#include "contact/pair_forces.hpp"
#include "contact/skeleton_problem.hpp"
#include "contact/solve.hpp"
#include "contact/warm_lcp.hpp"

namespace anticrack::contact {

class JoinedProblem;

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

/// Rows of a mesh's inclusions in what follows: A of each, then where any tilts Bx and By of each.
std::vector<ddm::Terms> sweep_motions(const ddm::Skeleton& skeleton);

/// Whether numbers hold inclusions, and of the held values the part that a load gives, or that
/// numbers give.
bool held_by_numbers(const ddm::Skeleton& skeleton);
Eigen::VectorXd held_part(const ddm::Decomposition& decomposition,
                          std::span<const ddm::CondensedLoad> loads, bool numbers);

/// Loads with every contact closed, a column each. Of a combination sum_j c_j f_j all but the
/// energy are linear in c, and that is c' energy c. Where numbers hold inclusions they are a load
/// of their own, the last column, and every row has it once.
struct SweepLoads {
  Eigen::MatrixXd r, magnitude;  ///< (contacts, loads), SkeletonProblem::Reduced
  Eigen::MatrixXd motion;        ///< (motions, loads)
  Eigen::MatrixXd energy;        ///< (loads, loads), symmetric: Pi

  /// Memory of its arrays.
  std::size_t bytes() const noexcept;
};

/// `constants`: (loads, loads), the part of the energy that the traces do not change (sum over the
/// subdomains of ddm::LoadProducts::energy; of one load: of energy_constant). O(n^2) a load; where
/// the membrane is joined two solves.
SweepLoads reduce(const SkeletonProblem& problem, std::span<const CaseLoads> loads,
                  const Eigen::MatrixXd& constants);
SweepLoads reduce(const JoinedProblem& problem, std::span<const CaseLoads> loads,
                  const Eigen::MatrixXd& constants);

/// The contact problem of one row after another, each started from the contact of the one before.
class RowContact {
 public:
  virtual ~RowContact() = default;
  /// What follows is valid until the next call if this returns `solved`.
  virtual LcpStatus solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude) = 0;
  virtual const Eigen::VectorXd& d() const = 0;          ///< (contacts with own jumps) >= 0
  virtual const Eigen::VectorXd& lambda() const = 0;     ///< (conditions) >= 0
  virtual const std::vector<char>& pressed() const = 0;  ///< LcpAnswer::pressed
  virtual const std::vector<char>& closed() const = 0;
  virtual double residual() const = 0;  ///< WarmLcp::residual
  virtual int steps() const = 0;
  /// What the jumps do to sweep_motions.
  virtual void motion(Eigen::VectorXd& of_jumps) const = 0;
};
/// `start`: closed contacts; empty: all. Keep references.
std::unique_ptr<RowContact> rows_of(const SkeletonProblem& problem, const ActiveSetOptions& options,
                                    std::span<const char> start);
std::unique_ptr<RowContact> rows_of(const JoinedProblem& problem, const ActiveSetOptions& options,
                                    std::span<const char> start);

/// Takes the work of forces on held inclusions from the energy.
void take_from_holders(std::span<const CaseLoads> loads, SweepLoads& reduced);

/// Solves row after row, each from the contact of the one before. A row's numbers are those of
/// solve_active_set for the same load, to rounding, and do not depend on the rows before. No
/// allocation in a row but as WarmLcp says. One object belongs to one thread. Keeps references to
/// what it is made of.
///   Pi = Pi(closed) - r'd/2                          (from d'lambda = 0)
///   A  = A(closed) + what the jumps do, and so the slopes
///   kkt: WarmLcp::residual, the largest |lambda - (S^ d - r)| relative to the largest force on the
///        contacts, of all the loads that are summed, with d and lambda clipped at 0 and one of
///        them 0 in each: what is wrong with equilibrium, gap, sign or complementarity of the
///        contacts is in it. The nodes between are in equilibrium by elimination, to rounding; it
///        is not measured row by row.
class SweepSolver {
 public:
  SweepSolver(const TraceProblem& traces, const SweepGeometry& geometry,
              std::unique_ptr<RowContact> contact);

  /// Writes one row. Ends not_converged, with zeros, where max_steps is reached, where a part that
  /// only contact holds is pulled off, and where a number is beyond the range of double.
  void solve(const SweepLoads& loads, std::span<const double> coefficients, std::size_t row,
             SweepColumns& rows);

  const std::vector<char>& closed() const noexcept { return _contact->closed(); }

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
