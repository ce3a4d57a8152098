// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "contact/dense_lcp.hpp"
#include "contact/solve.hpp"
#include "contact/trace_problem.hpp"
#include "contact/trace_state.hpp"

namespace anticrack::contact {

/// State and sample of one load case from what the contact problem gives. Keeps references.
class CaseState {
 public:
  CaseState(const TraceProblem& traces, const CaseLoads& loads) : _traces(traces), _loads(loads) {}

  /// The state, whose traces and fluxes are set from outside.
  TraceState& state() noexcept { return _state; }
  const TraceState& state() const noexcept { return _state; }
  Sample& sample() noexcept { return _sample; }
  const Sample& sample() const noexcept { return _sample; }

  /// The motions of the inclusions from the skeleton's values.
  void set_motion(const Eigen::VectorXd& w);
  /// Pressures, jumps, energy and residuals. `jumps` and `lambda`: of all contacts.
  void fill(const Eigen::VectorXd& jumps, const Eigen::VectorXd& lambda);
  /// Nodes that just touch are not in contact: their pressure is rounding.
  void settle_contact(std::vector<char> pressed, const Eigen::VectorXd& lambda);

 private:
  const TraceProblem& _traces;
  CaseLoads _loads;
  TraceState _state;
  Sample _sample;
};

/// The answer of a load case, with its reason where it is not converged. Throws errors::Error
/// (numerical) where the energy overflows.
Answer conclude(const TraceProblem& traces, const mesh::Mesh& mesh, const CaseLoads& loads,
                const CaseState& solved, const LcpAnswer& solution);

}  // namespace anticrack::contact
