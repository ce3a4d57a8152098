// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/sampled_triangle.hpp"

namespace anticrack::fem {

/// Integrates f phi_i over a triangle where f is smooth but too steep for the rule of 15 points:
/// by a product rule of 49 points (degree 12) as soon as the decay promises enough of it, and by
/// quarters, up to three times. `part`: what sample_triangle gave; replaced on success. False, and
/// `part` unchanged, when a break shows or the quarters do not suffice for `tolerance` (of a nodal
/// value): then the triangle is to be swept as a whole.
bool refine_smooth_triangle(const Triangle& triangle, double tolerance, SampledTriangle& part,
                            CountedField& field);

}  // namespace anticrack::fem
