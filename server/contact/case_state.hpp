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
  /// `tied`: as in LcpOptions; pairs that are tied have mu of either sign and are in no contact.
  CaseState(const TraceProblem& traces, const CaseLoads& loads, std::span<const char> tied = {})
      : _traces(traces), _loads(loads), _tied(tied) {}

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
  /// Values of contacts or pairs, 0 where they are tied.
  Eigen::VectorXd of_loose_contacts(const Eigen::VectorXd& lambda) const;
  Eigen::VectorXd of_loose_pairs(const Eigen::VectorXd& mu) const;
  const TraceProblem& _traces;
  CaseLoads _loads;
  const std::span<const char> _tied;
  TraceState _state;
  Sample _sample;
};

/// Makes the answer of a load case; it has a reason if it has not converged. Throws errors::Error
/// (numerical) if the energy overflows.
Answer conclude(const TraceProblem& traces, const mesh::Mesh& mesh, const CaseLoads& loads,
                const CaseState& solved, const LcpAnswer& solution);

}  // namespace anticrack::contact
