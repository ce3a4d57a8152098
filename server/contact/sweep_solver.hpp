// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solves many load cases on one mesh for the numbers of their answers alone, without traces.
// Whatever is linear in the load is computed once, for a basis of loads.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contact/contact_problem.hpp"
#include "contact/options.hpp"
#include "contact/pair_forces.hpp"
#include "contact/solve.hpp"
#include "contact/sweep_columns.hpp"

namespace anticrack::contact {

/// What the rows of all sweeps on a mesh have in common.
struct SweepGeometry {
  explicit SweepGeometry(const TraceProblem& traces);

  /// Interface nodes that may open (interface, index of the node in it), and the contact condition
  /// of each. A condition occurs twice where interfaces cross.
  std::vector<std::array<std::int32_t, 2>> nodes;
  std::vector<std::int32_t> contact;
  /// Where the contact of nodes of ContactLength is found: nodes and their contact conditions, and
  /// those whose pair is closed if all contacts of a path are.
  std::vector<std::array<std::int32_t, 2>> measured;
  struct Implied {
    std::int32_t node;
    std::vector<std::int32_t> path;  ///< contacts from its plus to its minus side
  };
  std::vector<Implied> implied;

  /// Memory of its arrays.
  std::size_t bytes() const noexcept;
};

/// Loads with every contact closed, one per column. For a combination sum_j c_j f_j the energy is
/// c' energy c, and everything else is linear in c. If inclusions are held at given numbers, these
/// are one more load in the last column, which every row takes with coefficient 1.
struct SweepLoads {
  Eigen::MatrixXd r, magnitude;                ///< (contacts, loads), as in Reduced
  Eigen::MatrixXd motion;                      ///< (motions, loads)
  Eigen::MatrixXd energy;                      ///< (loads, loads), symmetric: Pi
  std::shared_ptr<OpenResponses> responses{};  ///< to r, if many rows combine the loads

  /// sum of |c_j c_k Pi_jk|: what may cancel in the energy of a combination. O(m^2).
  double parts_energy(std::span<const double> coefficients) const;
  /// Memory of its arrays.
  std::size_t bytes() const noexcept;
};

/// Reduces a basis of loads. `constants`: (loads, loads), the part of the energy that does not
/// depend on the traces: the sum over the subdomains of ddm::LoadProducts::energy (for one load, of
/// energy_constant). O(n^2) a load; two solves if the membrane is joined.
SweepLoads reduce(const ContactProblem& problem, std::span<const CaseLoads> loads,
                  const Eigen::MatrixXd& constants);

/// Rows of coefficients (rows, loads), row-major, in an order for SweepSolver: that of row_order,
/// each load weighed by its r.
std::vector<std::size_t> solving_order(const SweepLoads& loads,
                                       std::span<const double> coefficients, std::size_t rows);

/// Solves row after row, each starting from the contact of the one before. The numbers of a row are
/// those of solve_active_set for the same load, to rounding, and do not depend on the rows before.
/// A row allocates only where LcpSequence does. One object belongs to one thread. Keeps references
/// to the arguments of its constructor.
///   Pi = Pi(closed) - r'd/2                          (from d'lambda = 0)
///   A  = A(closed) + what the jumps do, and so the slopes
///   kkt: LcpAnswer::residual, the largest |lambda - (S^ d - r)| of all summed loads, relative to
///        the largest force on the contacts, with d and lambda clipped at 0 and one of them 0 in
///        each contact, and S^ d - r, where OpenResponses pay, the sum of the responses. It covers
///        errors of equilibrium, gap, sign and complementarity at the contacts. The nodes between
///        are in equilibrium to rounding, by elimination, which is not measured row by row.
class SweepSolver {
 public:
  /// `start`: closed contacts to start the first row from; empty: all are closed. `responses`:
  /// to the loads that all rows combine; null: each row has its own.
  SweepSolver(const ContactProblem& problem, const SweepGeometry& geometry,
              const ActiveSetOptions& options, std::span<const char> start,
              OpenResponses* responses);

  /// Solves and writes one row. It ends not_converged, with zeros, if max_steps is reached, if a
  /// part that only contact holds is pulled off, or if a number is beyond the range of double.
  void solve(const SweepLoads& loads, std::span<const double> coefficients, std::size_t row,
             SweepColumns& rows);

  /// The solution of the last row.
  const LcpAnswer& answer() const noexcept { return _contact->answer(); }
  const std::vector<char>& closed() const noexcept { return _contact->answer().closed; }

 private:
  bool combine(const SweepLoads& loads, std::span<const double> coefficients);
  bool write(std::size_t row, SweepColumns& rows);
  double contact_length();

  const SweepGeometry& _geometry;
  const PairForces& _forces;
  const ContactLength& _length;
  std::vector<ContactLength::Value> _values;
  std::unique_ptr<RowContact> _contact;
  std::vector<char> _pressed;
  Eigen::VectorXd _coefficients, _sizes, _r, _magnitude, _motion, _of_jumps, _product;
  double _energy = 0;
};

}  // namespace anticrack::contact
