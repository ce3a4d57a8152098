// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far an iterate is from the conditions that a solution satisfies.
#pragma once

#include "fields/fields.hpp"

namespace anticrack::contact {

/// Residuals of the optimality conditions at an iterate. Relative ones are over the largest force
/// (condensed load, M mu, or of held values), the largest trace |u|, the largest |mu|, and the
/// product of the last two; a residual of 0 is 0.
struct KktResiduals {
  double equilibrium = 0;  ///< max |(S t - g +- M mu)_i|, force; zero to rounding in Algorithm 2
  double gap = 0;          ///< max violation of [u] = 0 (glue, tips) and [u] >= 0 (cracks)
  double sign = 0;         ///< max(0, -mu) on cracks
  double complementarity = 0;  ///< max |mu_i [u]_i| on cracks
};
ANTICRACK_FIELDS(KktResiduals, equilibrium, gap, sign, complementarity)

/// An answer is converged only where none of its relative residuals is above this bound, whatever
/// stopped the method; kkt_tolerance takes its place where it is set. Algorithm 2's gap is for this
/// relative to max_i |u_i|_V / sqrt(T_i) where that is larger than all traces, which a closing load
/// leaves near 0. The paper's examples on the paper's mesh end below 4e-5.
constexpr double solution_residual = 1e-4;

}  // namespace anticrack::contact
