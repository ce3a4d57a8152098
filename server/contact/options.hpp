// SPDX-License-Identifier: GPL-3.0-or-later
//
// Options of the solvers, as plain data.
#pragma once

#include <optional>
#include <variant>

#include "fields/fields.hpp"

namespace anticrack::contact {

/// Its numbers are those of the API.
enum class Mass {
  lumped = 1,  ///< diagonal interface mass: the fixed point is the nodal contact problem
  consistent,  ///< the paper's int1d: a slightly different discrete problem
};

/// Parameters of Algorithm 2; the defaults are those of section 8 of the paper.
struct UzawaOptions {
  std::optional<double> theta = 2.0;  ///< relaxation, > 0; empty: 0.97 theta* of the mesh
  double epsilon = 1e-12;             ///< stop when the criterion of step 3 is below this; > 0
  double p = 1e5;                     ///< bound on the multipliers; >= 0
  int max_iterations = 20000;         ///< >= 1
  Mass mass = Mass::lumped;
  /// if set, > 0: bound on the relative KKT residuals, in place of epsilon and of solution_residual
  std::optional<double> kkt_tolerance;
};
ANTICRACK_FIELDS(UzawaOptions, theta, epsilon, p, max_iterations, mass, kkt_tolerance)

/// Primal-dual active set: exact contact in a handful of steps.
struct ActiveSetOptions {
  double tolerance =
      1e-12;             ///< >= 0; relative jump or pressure below which a node is weakly active
  int max_steps = 1000;  ///< >= 1
};
ANTICRACK_FIELDS(ActiveSetOptions, tolerance, max_steps)

using SolverOptions = std::variant<ActiveSetOptions, UzawaOptions>;

/// Throws errors::Error (invalid_argument) with the field at fault below the method's name:
/// "uzawa.theta", "uzawa.epsilon", "uzawa.p", "uzawa.max_iterations", "uzawa.kkt_tolerance",
/// "active_set.tolerance", "active_set.max_steps".
void check(const SolverOptions& options, int iteration_limit);

}  // namespace anticrack::contact
