// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "base/at.hpp"
#include "contact/options.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

/// Result of one iteration of Algorithm 2 for a column.
struct Iterate {
  int number = 0;        ///< 1 for the paper's k = 0
  double criterion = 1;  ///< step 3; 1 in the first iteration
  double energy = 0;     ///< Pi_1 + Pi_2
  double size = 0;       ///< max_i |u_i|_V / sqrt(T_i), the size of the displacement in the
                         ///< subdomains
  bool turned = false;   ///< the change of mu points against the change before (in the M product)
};

/// Algorithm 2 of the paper in trace space, for many loads at once, a column each. With B_i the
/// signed incidence of pairs and traces of subdomain i (-1 minus side, +1 plus side):
///
///   t_i = F_i (g_i + B_i'M mu_k),   mu_{k+1} = P(mu_k + theta (t_minus - t_plus))
///
/// where P clips to [0,p] on cracks (gamma_c) and to [-p,p] on tied pairs (gamma_g). F_i holds the
/// section 6 projection, so w_k, y_k^0, y_k and A_k = -c_k/b_k of the paper are inside it.
/// Norms and energies need no further product: t'S t = t'(g + B'M mu) as t = F(g + B'M mu), and the
/// same holds for the change of t.
/// F_i times all columns is one product of matrices, so the columns that iterate must be the first
/// ones; the caller assigns columns to load cases (UzawaBlock). The columns are independent. All
/// memory is allocated on construction: O(n_G capacity). One object belongs to one thread.
class Uzawa {
 public:
  /// Keeps a reference to the problem. Every subdomain must have a flexibility, and every inclusion
  /// its rigid sides in one subdomain (ddm::uzawa_obstacle).
  Uzawa(const TraceProblem& problem, Mass mass, int capacity);

  /// Starts the iteration of a load in a column, with mu_0 = 0. `loads`, one per subdomain, must
  /// outlive the use of the column.
  void start(int column, std::span<const ddm::CondensedLoad> loads, double theta, double p);
  /// Computes the next iterate of the first `columns` columns. O(n_G^2 columns), no allocation.
  void step(int columns);
  /// Exchanges two columns. O(n_G), no allocation.
  void exchange(int a, int b);

  /// The iterate that step() computed last in a column.
  const Iterate& iterate(int column) const { return _columns[index(column)].iterate; }
  /// The trace of u_{i,k} on a subdomain.
  Eigen::Ref<const Eigen::VectorXd> trace(int column, std::size_t subdomain) const {
    const Side& side = _sides[subdomain];
    return _trace.col(column).segment(side.first, side.size);
  }
  /// mu_k, per pair, from which u_k was computed.
  Eigen::MatrixXd::ConstColXpr mu(int column) const { return _mu.col(column); }
  /// u+ - u-, per pair.
  Eigen::MatrixXd::ConstColXpr jump(int column) const { return _jump.col(column); }
  /// A_k of an inclusion.
  double displacement(int column, std::size_t inclusion) const {
    return _trace(_inclusion_row[inclusion], column);
  }

  /// equilibrium_residual of the iterate. O(n_G^2), no allocation.
  double equilibrium(int column);
  /// The scales of a column's relative residuals. O(n_G), no allocation.
  Scales scales(int column) const;
  /// Number of pairs whose mu is at its bound p and, by a gap above rounding, would go beyond it.
  /// With such pairs the iteration tends to the solution of another problem. O(n_G), no allocation.
  int held_at_bound(int column) const;
  /// The iterate with its forces and fluxes. O(n_G^2).
  TraceState state(int column) const;

 private:
  struct Column {
    std::span<const ddm::CondensedLoad> loads;
    double theta = 0;
    double p = 0;
    Iterate iterate;
  };
  struct Side {  // one subdomain: its rows, and workspace (skeleton, capacity)
    Eigen::Index first = 0, size = 0;
    Eigen::MatrixXd reduced, skeleton;
  };
  struct Pair {  // rows of its two sides
    Eigen::Index minus = 0, plus = 0;
    bool unilateral = false;
  };

  static std::size_t index(int column) noexcept { return at(column); }
  void update_multipliers(int column);
  void apply_forces(int columns);
  void solve_sides(int columns);
  void measure(int column);
  void measure_jump(int column);

  const TraceProblem& _problem;
  const Mass _mass;
  std::vector<Column> _columns;
  std::vector<Side> _sides;
  std::vector<Pair> _pairs;
  std::vector<Eigen::Index> _inclusion_row;          // a row that holds A_j
  Eigen::MatrixXd _mu, _jump, _pair_force, _change;  // (pairs, capacity)
  // (traces of all subdomains below each other, capacity); force is g + B'M mu.
  Eigen::MatrixXd _g, _trace, _force;
  Eigen::MatrixXd _previous_trace, _previous_force;  // within a step only
  std::vector<Eigen::VectorXd> _unbalanced;          // workspace of equilibrium(), per subdomain
  Eigen::VectorXd _on_motions;
};

}  // namespace anticrack::contact
