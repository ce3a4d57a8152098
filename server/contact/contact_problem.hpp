// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contact problem of one mesh, behind one interface for both ways to eliminate all but the
// jumps.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "contact/conditions.hpp"
#include "contact/dense_lcp.hpp"
#include "contact/solve.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

class OpenMembrane;

/// A load with every contact closed, after all but the jumps have been eliminated.
struct Reduced {
  Eigen::VectorXd force;      ///< f_x - K_xp p, for a joined membrane only
  Eigen::VectorXd x;          ///< y, the free values
  Eigen::VectorXd p;          ///< held values; empty: all 0
  Eigen::VectorXd r;          ///< per contact
  Eigen::VectorXd magnitude;  ///< sums of the absolute terms of r
  double size = 0;            ///< TraceState::load_size
};

/// u with every contact closed, the load and the internal forces K u; their products are works.
struct Work {
  Eigen::VectorXd u, load, internal;
};

/// State of a load case: x is the solution for the load and the jumps d.
struct Position {
  Reduced load;
  Eigen::VectorXd x, d;
};

/// Answer to a unit force on a sum of the skeleton's unknowns, every contact closed. Keeps a
/// reference to the sum.
struct UnitForce {
  const ddm::Terms* on;
  Eigen::VectorXd r;      ///< per contact
  double compliance = 0;  ///< the sum's displacement under the force
};

/// d = 0 on the closed contacts and (S^ d)_i = r_i on the open ones, whatever the signs; to 1e-10
/// of r if `solved`, which is false where nothing but contact holds a part.
struct Opened {
  Eigen::VectorXd d;
  Eigen::VectorXd residual;  ///< r - S^ d: minus the reactions of the closed contacts
  bool solved = true;
};

/// A unit force on a sum of unknowns, and the jumps d.
struct Displaced {
  const ddm::Terms* force;
  Eigen::VectorXd d;
};

/// Solves the contact problem of one load after another, each starting from the contact of the one
/// before. For one thread.
class RowContact {
 public:
  virtual ~RowContact() = default;
  /// `coefficients`: r = loads * coefficients, if the loads are known.
  virtual void solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude,
                     const Eigen::VectorXd& coefficients) = 0;
  /// The answer to the last load; before the first load only `closed` is set.
  virtual const LcpAnswer& answer() const = 0;
  /// How much the jumps of the answer change each of the sums of the skeleton's unknowns.
  virtual void motion(Eigen::VectorXd& of_jumps) const = 0;
};

/// With K the stiffness of the membrane and values x (free), d (jumps) and p (held) of which its
/// unknowns are made (Maps), f the load on them:
///
///   K = [A  B' .; B  D  .; . . .],   A x + B'd + K_xp p = f_x
///   S^ = D - B A^-1 B',   r = f_d - K_dp p - B y,   y = A^-1 (f_x - K_xp p)
///   Conditions:  d >= 0,  lambda = S^ d - r >= 0,  d'lambda = 0;     x = y - A^-1 B'd
///
/// In a CondensedProblem x are values of the skeleton, and S^ is a dense matrix; in a JoinedProblem
/// the interiors of the subdomains come first in x, and S^ d takes a solve. Immutable after
/// construction, thread-safe. Keeps a reference to the traces.
class ContactProblem {
 public:
  virtual ~ContactProblem() = default;
  ContactProblem(const ContactProblem&) = delete;
  ContactProblem& operator=(const ContactProblem&) = delete;

  const TraceProblem& traces() const noexcept { return _traces; }
  const Conditions& conditions() const noexcept { return _conditions; }
  /// Whether loads and interiors are condensed to the traces. If so, every step of the active set
  /// has traces, and TraceState::of_interiors is 0.
  bool condensed() const noexcept { return _condensed; }

  /// Loads of a subdomain, one per column; arguments as for ddm::SubdomainOperator::condense. O(N).
  virtual std::vector<ddm::CondensedLoad> loads(
      std::size_t subdomain, const Eigen::Ref<const Eigen::MatrixXd>& of_nodes,
      const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const = 0;

  /// Eliminates all but the jumps. `loads`: one per subdomain, or empty if nothing acts. `p`:
  /// held_values. `refined`: adds a step of iterative refinement, after which x and r are right to
  /// rounding of the load; a joined membrane always does so. O(n^2); joined: two solves.
  Reduced reduce(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& p,
                 bool refined = false) const;
  /// The same for a unit force on a sum of unknowns. Cost as reduce().
  UnitForce unit_force(const ddm::Terms& on) const;
  /// The compliance of each unit force. Cost as unit_force(); joined: half a solve.
  virtual std::vector<double> compliances(std::span<const ddm::Terms* const> sums) const;
  /// The skeleton's values w. O(n).
  Eigen::VectorXd values(const Eigen::VectorXd& x, const Eigen::VectorXd& d,
                         const Eigen::VectorXd& p) const;
  /// lambda from the fluxes of a state and the set of closed conditions. O(n).
  Eigen::VectorXd multipliers(const TraceState& state, const std::vector<char>& closed) const;

  /// x for jumps d. O(n c); joined: two solves.
  virtual Eigen::VectorXd solve(const Reduced& load, const Eigen::VectorXd& d) const = 0;
  /// Work of a reduced load with every contact closed. O(n^2); joined: O(N).
  virtual Work work(std::span<const ddm::CondensedLoad> loads, const Reduced& reduced) const = 0;
  /// Fills traces, fluxes and the energy of the interiors. O(n^2); joined: O(N).
  virtual void fill(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& x,
                    const Eigen::VectorXd& w, TraceState& state) const = 0;
  /// Does a step of iterative refinement; d does not change on the closed contacts. O(n^2); joined:
  /// a few solves for each iteration of conjugate gradients.
  virtual void refine(std::span<const ddm::CondensedLoad> loads, const TraceState& state,
                      const LcpAnswer& solution, Position& position) const = 0;

  /// Solves for contact. `start`: closed contacts to start from; empty: the problem chooses them.
  virtual LcpAnswer solve_contact(const Reduced& load, const LcpOptions& options,
                                  std::span<const char> start, const OnStep& on_step) const = 0;
  /// Solves with a given set of closed conditions; the bits for an r do not depend on the others.
  /// `closed`: one per condition, as in LcpStep; empty: none, for which a CondensedProblem keeps a
  /// factor: O(c^3), then O(c^2) each. `tolerance`: conjugate gradients stop there, relative in the
  /// norm of energy; 0: at rounding.
  virtual std::vector<Opened> solve_open(const std::vector<char>& closed,
                                         std::span<const Eigen::VectorXd> r,
                                         double tolerance = 0) const = 0;
  /// For each column, how far jumps d are from those that forces r on the contacts make with every
  /// contact open: |.|^2 of the difference of both fields, (d - S^-1 r)'S^(d - S^-1 r). Empty where
  /// S^ is not formed, as each would take solves, or singular. Costs O(c) for each d that is not 0,
  /// and O(c^2) a column.
  virtual Eigen::VectorXd apart(const Eigen::MatrixXd& d, const Eigen::MatrixXd& r) const = 0;
  /// A solver for rows of a sweep. `start`: closed contacts, empty: all; `motions`: sums of
  /// unknowns that RowContact::motion reports; `responses`: to loads of which each r is a
  /// combination; null: none are known. Keeps references.
  virtual std::unique_ptr<RowContact> rows(const LcpOptions& options, std::span<const char> start,
                                           std::vector<ddm::Terms> motions,
                                           OpenResponses* responses) const = 0;

  /// Fills Answer::fields; the bits of a case do not depend on the other cases. O(N) each.
  virtual void recover_fields(std::span<const SolvedCase> cases) const = 0;
  /// For each force, u on the nodes of all subdomains one after another, 0 on the Dirichlet
  /// boundary. O(N) each.
  virtual std::vector<std::vector<double>> fields_of(
      std::span<const Displaced> displaced) const = 0;
  /// A factor for unit forces with every contact open, about as large as this problem; null if
  /// solve_open keeps such a factor itself.
  virtual std::unique_ptr<const OpenMembrane> open_membrane() const;

  /// Memory of the matrices in bytes.
  virtual std::size_t bytes() const noexcept = 0;

 protected:
  ContactProblem(const TraceProblem& traces, bool condensed);
  const Maps& maps() const noexcept { return _traces.maps(); }
  /// Eliminates all but the jumps from forces h on the skeleton's unknowns and the interior part of
  /// `loads`.
  virtual Reduced eliminate(const Eigen::VectorXd& h, std::span<const ddm::CondensedLoad> loads,
                            const Eigen::VectorXd& p, bool refined) const = 0;

 private:
  const TraceProblem& _traces;
  const Conditions _conditions;
  const bool _condensed;
};

}  // namespace anticrack::contact
