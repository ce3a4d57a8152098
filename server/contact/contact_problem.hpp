// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contact problem of one mesh: what acts on it and what conditions hold, whichever way all but
// the jumps are eliminated.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "contact/conditions.hpp"
#include "contact/dense_lcp.hpp"
#include "contact/solve.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

class OpenMembrane;

/// A load with every contact closed, all but the jumps eliminated.
struct Reduced {
  Eigen::VectorXd force;      ///< on x, less what p takes; of a joined membrane
  Eigen::VectorXd x;          ///< the values that are free
  Eigen::VectorXd p;          ///< held values; empty: all 0
  Eigen::VectorXd r;          ///< per contact
  Eigen::VectorXd magnitude;  ///< sums of the absolute values r is made of
  double size = 0;            ///< TraceState::load_size
};

/// The closed state of a load, what acts and K u, in numbers whose products are works.
struct Work {
  Eigen::VectorXd u, load, internal;
};

/// Where a load case stands: x belongs to the load and to jumps d.
struct Position {
  Reduced load;
  Eigen::VectorXd x, d;
};

/// A unit force on a sum of the skeleton's unknowns, every contact closed. Refers to the sum.
struct UnitForce {
  const ddm::Terms* on;
  Eigen::VectorXd r;      ///< per contact
  double compliance = 0;  ///< the sum's own displacement
};

/// d = 0 on the closed contacts, (S^ d)_i = r_i on the open ones, whatever the signs, to 1e-10 of r
/// where `solved`: not so where nothing but contact holds a part.
struct Opened {
  Eigen::VectorXd d;
  Eigen::VectorXd residual;  ///< r - S^ d: minus the reactions of the closed contacts
  bool solved = true;
};

/// A unit force with jumps d.
struct Displaced {
  const ddm::Terms* force;
  Eigen::VectorXd d;
};

/// The contact problem of one load after another, each started from the contact of the one before.
/// For one thread.
class RowContact {
 public:
  virtual ~RowContact() = default;
  virtual void solve(const Eigen::VectorXd& r, const Eigen::VectorXd& magnitude) = 0;
  /// Of the last load; `closed` is there before the first.
  virtual const LcpAnswer& answer() const = 0;
  /// What the jumps of the answer do to sums of the skeleton's unknowns.
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
  /// Whether loads and interiors are condensed to the traces: then a step of the active set has
  /// traces of its own, and its energy none of interiors.
  bool condensed() const noexcept { return _condensed; }

  /// Loads of a subdomain, a column each; arguments as of ddm::SubdomainOperator::condense. O(N).
  virtual std::vector<ddm::CondensedLoad> loads(
      std::size_t subdomain, const Eigen::Ref<const Eigen::MatrixXd>& of_nodes,
      const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const = 0;

  /// `loads`: one per subdomain; or none, nothing acts. `p`: held_values. `refined`: with a step of
  /// iterative refinement, after which x and r are right to rounding of the load; always where the
  /// membrane is joined. O(n^2); joined: two solves.
  Reduced reduce(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& p,
                 bool refined = false) const;
  /// Of a unit force. As reduce().
  UnitForce unit_force(const ddm::Terms& on) const;
  /// w of the skeleton. O(n).
  Eigen::VectorXd values(const Eigen::VectorXd& x, const Eigen::VectorXd& d,
                         const Eigen::VectorXd& p) const;
  /// lambda from the fluxes of a state, given which conditions are closed. O(n).
  Eigen::VectorXd multipliers(const TraceState& state, const std::vector<char>& closed) const;

  /// x for jumps d. O(n c); joined: two solves.
  virtual Eigen::VectorXd solve(const Reduced& load, const Eigen::VectorXd& d) const = 0;
  /// Of a load, reduced, with every contact closed. O(n^2); joined: O(N).
  virtual Work work(std::span<const ddm::CondensedLoad> loads, const Reduced& reduced) const = 0;
  /// Traces, fluxes and the energy of the interiors. O(n^2); joined: O(N).
  virtual void fill(std::span<const ddm::CondensedLoad> loads, const Eigen::VectorXd& x,
                    const Eigen::VectorXd& w, TraceState& state) const = 0;
  /// A step of iterative refinement, with d unchanged on the closed contacts. O(n^2); joined: a few
  /// solves for each iteration of conjugate gradients.
  virtual void refine(std::span<const ddm::CondensedLoad> loads, const TraceState& state,
                      const LcpAnswer& solution, Position& position) const = 0;

  /// The contact problem of a load, from closed contacts `start`; empty: those that are known.
  virtual LcpAnswer solve_contact(const Reduced& load, const LcpOptions& options,
                                  std::span<const char> start, const OnStep& on_step) const = 0;
  /// For each r, with its own bits. `closed`: of all conditions, as in LcpStep; empty: none is,
  /// which has a factor of its own in a CondensedProblem: O(c^3), then O(c^2) each.
  virtual std::vector<Opened> solve_open(const std::vector<char>& closed,
                                         std::span<const Eigen::VectorXd> r) const = 0;
  /// `start`: closed contacts; empty: all. `motions`: sums of unknowns. Keeps references.
  virtual std::unique_ptr<RowContact> rows(const LcpOptions& options, std::span<const char> start,
                                           std::vector<ddm::Terms> motions) const = 0;

  /// Fills Answer::fields; the bits of a case do not depend on the others. O(N) each.
  virtual void recover_fields(std::span<const SolvedCase> cases) const = 0;
  /// u of each on the nodes of the subdomains one after another, 0 on the Dirichlet boundary. O(N)
  /// each.
  virtual std::vector<std::vector<double>> fields_of(
      std::span<const Displaced> displaced) const = 0;
  /// A factor of its own for unit forces with every contact open, about as large as this problem;
  /// null where solve_open has one.
  virtual std::unique_ptr<const OpenMembrane> open_membrane() const;

  /// Memory of the matrices.
  virtual std::size_t bytes() const noexcept = 0;

 protected:
  ContactProblem(const TraceProblem& traces, bool condensed);
  const Maps& maps() const noexcept { return _traces.maps(); }
  /// Of forces h on the skeleton's unknowns and of what `loads` have in the interiors.
  virtual Reduced eliminate(const Eigen::VectorXd& h, std::span<const ddm::CondensedLoad> loads,
                            const Eigen::VectorXd& p, bool refined) const = 0;

 private:
  const TraceProblem& _traces;
  const Conditions _conditions;
  const bool _condensed;
};

}  // namespace anticrack::contact
