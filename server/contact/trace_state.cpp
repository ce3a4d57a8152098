// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/trace_state.hpp"

#include <algorithm>
#include <cmath>

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

double ratio(double value, double scale) {
  return value == 0 ? 0 : value / scale;
}

double largest(const VectorXd& values) {
  return values.size() == 0 ? 0 : values.lpNorm<Eigen::Infinity>();
}

}  // namespace

std::vector<VectorXd> fluxes(const std::vector<ddm::SubdomainOperator>& operators,
                             std::span<const ddm::CondensedLoad> loads,
                             const std::vector<VectorXd>& traces) {
  std::vector<VectorXd> result;
  result.reserve(operators.size());
  for (std::size_t s = 0; s < operators.size(); ++s) {
    result.emplace_back(operators[s].factor().apply_schur(traces[s]) - loads[s].g);
  }
  return result;
}

double energy(std::span<const ddm::CondensedLoad> loads, const TraceState& state) {
  double of_traces = 0, constant = 0;
  for (std::size_t s = 0; s < loads.size(); ++s) {
    of_traces += state.trace[s].dot(state.flux[s] - loads[s].g) / 2;
    constant += loads[s].energy_constant;
  }
  // Beyond the range of double the two may be infinities of opposite sign.
  const double total = of_traces + constant;
  return std::isnan(total) && !std::isnan(constant) ? constant : total;
}

KktResiduals contact_residuals(const ddm::Decomposition& decomposition, const VectorXd& mu,
                               const VectorXd& jump) {
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
  double worst = 0;
  VectorXd on_inclusion = VectorXd::Zero(state.displacement.size());
  for (std::size_t s = 0; s < residual.size(); ++s) {
    const std::vector<std::int32_t>& rigid = decomposition.subdomains[s].rigid;
    for (Index k = 0; k < residual[s].size(); ++k) {
      if (rigid[at(k)] < 0) {
        worst = std::max(worst, std::abs(residual[s][k]));
      } else {
        on_inclusion[rigid[at(k)]] += residual[s][k];
      }
    }
  }
  return std::max(worst, largest(on_inclusion));
}

KktResiduals relative_residuals(const ddm::Decomposition& decomposition,
                                std::span<const ddm::CondensedLoad> loads, const TraceState& state,
                                const KktResiduals& absolute) {
  double force = largest(state.force), displacement = 0;
  for (std::size_t s = 0; s < loads.size(); ++s) {
    force = std::max(force, largest(loads[s].g));
    displacement = std::max(displacement, largest(state.trace[s]));
  }
  const double mu = largest(state.mu);
  KktResiduals result{ratio(absolute.equilibrium, force), ratio(absolute.gap, displacement),
                      ratio(absolute.sign, mu), 0};
  for (Index i = 0; i < state.mu.size(); ++i) {
    if (decomposition.pairs[at(i)].unilateral()) {
      result.complementarity =
          std::max(result.complementarity,
                   std::abs(ratio(state.mu[i], mu)) * std::abs(ratio(state.jump[i], displacement)));
    }
  }
  return result;
}

int contact_count(const ddm::Decomposition& decomposition, const VectorXd& mu) {
  int count = 0;
  for (Index i = 0; i < mu.size(); ++i) {
    count += decomposition.pairs[at(i)].unilateral() && mu[i] > 0 ? 1 : 0;
  }
  return count;
}

}  // namespace anticrack::contact
