// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/residuals.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_operator.hpp"

namespace anticrack::contact {

/// State of the membrane on its interfaces, whichever method computed it.
struct TraceState {
  std::vector<Eigen::VectorXd> trace;  ///< t_i, per subdomain
  std::vector<Eigen::VectorXd> flux;   ///< S t - g: int T du/dn phi_i, n outward
  double of_interiors = 0;             ///< energy of the interiors, where loads are not condensed
  /// Largest force that is not in the g of the loads: from held values and, where loads are not
  /// condensed, on interiors and contacts.
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

/// Pi = sum_i (t'S t/2 - g't + constant) of a state with fluxes; not finite if any term is beyond
/// the range of double. O(n_G).
double energy(std::span<const ddm::CondensedLoad> loads, const TraceState& state);

using ConstVectorRef = Eigen::Ref<const Eigen::VectorXd>;

/// value / scale, 0 where the value is 0, whatever the scale.
inline double ratio(double value, double scale) { return value == 0 ? 0 : value / scale; }

/// max |v_i|; 0 if there are no entries.
double largest(const ConstVectorRef& values);

/// Computes gap, sign and complementarity, and leaves `equilibrium` 0. O(n_G), no allocation.
KktResiduals contact_residuals(const ddm::Decomposition& decomposition, const ConstVectorRef& mu,
                               const ConstVectorRef& jump);
/// max |(S t - g - B'M mu)_i|; for the nodes of a rigid body instead the virtual work of these
/// forces on each free motion of the body (with largest displacement 1). O(n_G).
double equilibrium_residual(const ddm::Decomposition& decomposition, const TraceState& state);
/// The same for given forces S t - g - B'M mu, per subdomain. `on_motions` is workspace with
/// Skeleton::free entries. No allocation.
double largest_unbalanced(const ddm::Decomposition& decomposition,
                          std::span<const Eigen::VectorXd> forces, Eigen::VectorXd& on_motions);

/// The scales that residuals are relative to.
struct Scales {
  double force = 0;  ///< largest of |g|, |M mu| and TraceState::load_size
  double trace = 0;  ///< largest |t|
  double mu = 0;     ///< largest |mu|
};
/// Scales of the loads and of the state that solves them. O(n_G).
Scales scales_of(std::span<const ddm::CondensedLoad> loads, const TraceState& state);

/// Divides the residuals: equilibrium by force, gap by trace, sign by mu, complementarity by trace
/// times mu (without overflow). A residual of 0 stays 0. No allocation.
KktResiduals relative_residuals(const ddm::Decomposition& decomposition, const ConstVectorRef& mu,
                                const ConstVectorRef& jump, const Scales& scales,
                                const KktResiduals& absolute);

/// Whether none of the relative residuals is NaN or above `bound`.
bool within(const KktResiduals& relative, double bound);

/// Number of crack nodes with mu > 0.
int contact_count(const ddm::Decomposition& decomposition, const ConstVectorRef& mu);

}  // namespace anticrack::contact
