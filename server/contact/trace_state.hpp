// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_operator.hpp"

namespace anticrack::contact {

/// Where the membrane stands on its interfaces, whatever the method that brought it there.
struct TraceState {
  std::vector<Eigen::VectorXd> trace;  ///< t_i, per subdomain
  std::vector<Eigen::VectorXd> flux;   ///< S t - g: int T du/dn phi_i, n outward
  double of_interiors = 0;             ///< where loads are not condensed: their energy
  /// Largest force that condensed loads do not show: of held values; where loads are not condensed
  /// also of those on interiors and contacts.
  double load_size = 0;
  Eigen::MatrixXd motion;     ///< (3, inclusions): A, and B in x and y
  Eigen::VectorXd mu;         ///< per pair
  Eigen::VectorXd force;      ///< M mu, per pair
  Eigen::VectorXd jump;       ///< u+ - u-, per pair
  std::vector<char> contact;  ///< per pair: 1 where it may open and is closed under pressure
};

/// S_i t_i - g_i of every subdomain. O(n_G^2).
std::vector<Eigen::VectorXd> fluxes(const std::vector<ddm::SubdomainOperator>& operators,
                                    std::span<const ddm::CondensedLoad> loads,
                                    const std::vector<Eigen::VectorXd>& traces);

/// Pi = sum_i (t'S t/2 - g't + constant), of a state with fluxes; not finite where a part of it is
/// beyond the range of double. O(n_G).
double energy(std::span<const ddm::CondensedLoad> loads, const TraceState& state);

using ConstVectorRef = Eigen::Ref<const Eigen::VectorXd>;

/// value / scale, 0 where the value is 0, whatever the scale.
inline double ratio(double value, double scale) { return value == 0 ? 0 : value / scale; }

/// max |v_i|, 0 without entries.
double largest(const ConstVectorRef& values);

/// gap, sign and complementarity; `equilibrium` is left 0. O(n_G), no allocation.
KktResiduals contact_residuals(const ddm::Decomposition& decomposition, const ConstVectorRef& mu,
                               const ConstVectorRef& jump);
/// max |(S t - g - B'M mu)_i|, for nodes held rigid the virtual work of it on each free motion of
/// their body (whose largest displacement is 1). O(n_G).
double equilibrium_residual(const ddm::Decomposition& decomposition, const TraceState& state);
/// The same of forces S t - g - B'M mu that are at hand, per subdomain. `on_motions` is workspace,
/// Skeleton::free entries. No allocation.
double largest_unbalanced(const ddm::Decomposition& decomposition,
                          std::span<const Eigen::VectorXd> forces, Eigen::VectorXd& on_motions);

/// What residuals are relative to.
struct Scales {
  double force = 0;  ///< largest of what acts: |g|, |M mu|, TraceState::load_size
  double trace = 0;  ///< largest |t|
  double mu = 0;     ///< largest |mu|
};
/// Of the loads and the state they led to. O(n_G).
Scales scales_of(std::span<const ddm::CondensedLoad> loads, const TraceState& state);

/// The residuals relative to: force (equilibrium), trace (gap), mu (sign), the product of the last
/// two (complementarity, formed without overflow). 0 where the residual is 0. No allocation.
KktResiduals relative_residuals(const ddm::Decomposition& decomposition, const ConstVectorRef& mu,
                                const ConstVectorRef& jump, const Scales& scales,
                                const KktResiduals& absolute);

/// Whether each of the relative residuals is a number of at most `bound`.
bool within(const KktResiduals& relative, double bound);

/// Crack nodes with mu > 0.
int contact_count(const ddm::Decomposition& decomposition, const ConstVectorRef& mu);

}  // namespace anticrack::contact
