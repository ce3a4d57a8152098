// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

/// What one iteration of Algorithm 2 leaves behind.
struct Iterate {
  int number = 0;                      ///< 1 for the paper's k = 0
  std::vector<Eigen::VectorXd> trace;  ///< of u_{i,k}, per subdomain
  Eigen::VectorXd displacement;        ///< A_k, per inclusion
  Eigen::VectorXd mu;                  ///< mu_k, per pair: what u_k was computed from
  Eigen::VectorXd jump;                ///< u+ - u-, per pair
  double criterion = 1;                ///< step 3; 1 in the first iteration
  double energy = 0;                   ///< Pi_1 + Pi_2
  bool turned = false;  ///< the change of mu points against the change before (in the M product)
};

/// Algorithm 2 of the paper in trace space, one iteration a call. With B_i the signed incidence of
/// pairs and traces of subdomain i (-1 minus side, +1 plus side):
///
///   t_i = F_i (g_i + B_i'M mu_k),   mu_{k+1} = P(mu_k + theta (t_minus - t_plus))
///
/// where P clips to [0,p] on cracks (gamma_c) and to [-p,p] on tied pairs (gamma_g). F_i holds the
/// section 6 projection, so w_k, y_k^0, y_k and A_k = -c_k/b_k of the paper are inside it.
/// Norms and energies need no further product: t'S t = t'(g + B'M mu) as t = F(g + B'M mu), and the
/// same holds for the change of t.
/// One object belongs to one thread. O(n_G^2) an iteration, no allocation.
class Uzawa {
 public:
  /// `loads`: one per subdomain. Keeps references to both. mu_0 = 0. Every subdomain must have a
  /// flexibility, and every inclusion its rigid sides in one subdomain (ddm::uzawa_obstacle).
  Uzawa(const TraceProblem& problem, std::span<const ddm::CondensedLoad> loads, double theta,
        double p, Mass mass);

  /// Computes the next iterate.
  const Iterate& step();
  const Iterate& iterate() const noexcept { return _iterate; }

  /// The iterate with its forces and fluxes. O(n_G^2).
  TraceState state() const;

 private:
  struct Side {  // workspace of one subdomain
    Eigen::VectorXd force, previous_force, previous_trace, reduced, skeleton;
  };
  struct Held {  // where A_j is found: subdomain and skeleton column
    std::size_t subdomain;
    Eigen::Index column;
  };

  void update_multipliers();
  void apply_forces();
  void solve_sides();

  const TraceProblem& _problem;
  std::span<const ddm::CondensedLoad> _loads;
  double _theta;
  double _p;
  Mass _mass;
  Iterate _iterate;
  std::vector<Side> _sides;
  std::vector<Held> _inclusions;
  Eigen::VectorXd _pair_force, _change, _previous_change;
};

}  // namespace anticrack::contact
