// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/dense_lcp.hpp"
#include "contact/observer.hpp"
#include "contact/solve.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

/// State and sample of one load case, made from jumps and multipliers. Keeps references.
class CaseState {
 public:
  CaseState(const TraceProblem& traces, const CaseLoads& loads) : _traces(traces), _loads(loads) {}

  /// The state; the caller sets its traces and fluxes.
  TraceState& state() noexcept { return _state; }
  const TraceState& state() const noexcept { return _state; }
  Sample& sample() noexcept { return _sample; }
  const Sample& sample() const noexcept { return _sample; }

  /// Sets the motions of the inclusions from the skeleton's values w.
  void set_motion(const Eigen::VectorXd& w);
  /// Computes pressures, jumps, energy and residuals. `jumps` and `lambda`: one per contact.
  void fill(const Eigen::VectorXd& jumps, const Eigen::VectorXd& lambda);
  /// Marks the pairs in contact; nodes that just touch are not, since their pressure is rounding.
  void settle_contact(std::vector<char> pressed, const Eigen::VectorXd& lambda);

 private:
  const TraceProblem& _traces;
  CaseLoads _loads;
  TraceState _state;
  Sample _sample;
};

/// Makes the answer of a load case; it has a reason if it has not converged. Throws errors::Error
/// (numerical) if the energy overflows.
Answer conclude(const TraceProblem& traces, const mesh::Mesh& mesh, const CaseLoads& loads,
                const CaseState& solved, const LcpAnswer& solution);

}  // namespace anticrack::contact
