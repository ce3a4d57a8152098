// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/trace_state.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"

namespace anticrack::contact {

using Eigen::Index;
using Eigen::VectorXd;

double largest(const ConstVectorRef& values) {
  return values.size() == 0 ? 0 : values.lpNorm<Eigen::Infinity>();
}

std::vector<VectorXd> fluxes(const std::vector<ddm::SubdomainOperator>& operators,
                             std::span<const ddm::CondensedLoad> loads,
                             const std::vector<VectorXd>& traces) {
  std::vector<VectorXd> result;
  result.reserve(operators.size());
  for (std::size_t s = 0; s < operators.size(); ++s)
    result.emplace_back(operators[s].factor().apply_schur(traces[s]) - loads[s].g);
  return result;
}

double energy(std::span<const ddm::CondensedLoad> loads, const TraceState& state) {
  double of_traces = 0, constant = 0;
  for (std::size_t s = 0; s < loads.size(); ++s) {
    of_traces += state.trace[s].dot(state.flux[s] - loads[s].g) / 2;
    constant += loads[s].energy_constant;
  }
  return of_traces + constant + state.of_interiors;
}

KktResiduals contact_residuals(const ddm::Decomposition& decomposition, const ConstVectorRef& mu,
                               const ConstVectorRef& jump) {
  KktResiduals result;
  for (Index i = 0; i < mu.size(); ++i) {
    if (decomposition.pairs[at(i)].unilateral()) {
      result.gap = std::max(result.gap, -jump[i]);
      result.sign = std::max(result.sign, -mu[i]);
      result.complementarity = std::max(result.complementarity, std::abs(mu[i] * jump[i]));
    } else {
      result.gap = std::max(result.gap, std::abs(jump[i]));
    }
  }
  return result;
}

double equilibrium_residual(const ddm::Decomposition& decomposition, const TraceState& state) {
  std::vector<VectorXd> residual = state.flux;
  for (Index i = 0; i < state.force.size(); ++i) {
    const ddm::NodePair& pair = decomposition.pairs[at(i)];
    residual[at(pair.minus)][pair.minus_trace] += state.force[i];
    residual[at(pair.plus)][pair.plus_trace] -= state.force[i];
  }
  VectorXd on_motions(static_cast<Index>(decomposition.skeleton.free));
  return largest_unbalanced(decomposition, residual, on_motions);
}

double largest_unbalanced(const ddm::Decomposition& decomposition, std::span<const VectorXd> forces,
                          VectorXd& on_motions) {
  double worst = 0;
  on_motions.setZero();
  for (std::size_t s = 0; s < forces.size(); ++s) {
    const ddm::Subdomain& subdomain = decomposition.subdomains[s];
    for (Index k = 0; k < forces[s].size(); ++k) {
      if (subdomain.rigid[at(k)] < 0) {
        worst = std::max(worst, std::abs(forces[s][k]));
        continue;
      }
      for (const auto& [motion, factor] :
           decomposition.skeleton.rows[at(subdomain.unknown[at(k)])].free)
        on_motions[motion] += factor * forces[s][k];
    }
  }
  return std::max(worst, largest(on_motions));
}

Scales scales_of(std::span<const ddm::CondensedLoad> loads, const TraceState& state) {
  Scales result{std::max(largest(state.force), state.load_size), 0, largest(state.mu)};
  for (std::size_t s = 0; s < loads.size(); ++s) {
    result.force = std::max(result.force, largest(loads[s].g));
    result.trace = std::max(result.trace, largest(state.trace[s]));
  }
  return result;
}

KktResiduals relative_residuals(const ddm::Decomposition& decomposition, const ConstVectorRef& mu,
                                const ConstVectorRef& jump, const Scales& scales,
                                const KktResiduals& absolute) {
  KktResiduals result{ratio(absolute.equilibrium, scales.force), ratio(absolute.gap, scales.trace),
                      ratio(absolute.sign, scales.mu), 0};
  for (Index i = 0; i < mu.size(); ++i) {
    if (decomposition.pairs[at(i)].unilateral()) {
      result.complementarity =
          std::max(result.complementarity,
                   std::abs(ratio(mu[i], scales.mu)) * std::abs(ratio(jump[i], scales.trace)));
    }
  }
  return result;
}

bool within(const KktResiduals& relative, double bound) {
  return relative.equilibrium <= bound && relative.gap <= bound && relative.sign <= bound &&
         relative.complementarity <= bound;
}

int contact_count(const ddm::Decomposition& decomposition, const ConstVectorRef& mu) {
  int count = 0;
  for (Index i = 0; i < mu.size(); ++i)
    count += decomposition.pairs[at(i)].unilateral() && mu[i] > 0 ? 1 : 0;
  return count;
}

}  // namespace anticrack::contact
