// SPDX-License-Identifier: GPL-3.0-or-later
//
// The figures of a load as pure functions of the result. Colours are safe for colour-blind readers
// (Okabe & Ito; viridis). The gnuplot scripts hold numbers, fixed text and strings made by
// `quoted`; the only file they name is that of `Output`. A Picture refers to the arguments it was
// made of.
#pragma once

#include "figures/canvas.hpp"
#include "figures/surface.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// Degrees about the vertical. The view is over the minus side at the interface: the crack opens
/// upwards on the far side ([u] >= 0).
double membrane_view(const results::Result& result);

/// Deformed membrane, slit open.
Picture membrane_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface);

/// u-, u+ and [u] over the arc length of an interface, and where it is in contact.
Picture traces_picture(const results::Result& result, const results::Load& load,
                       std::size_t interface);

/// The criterion of step 3 of Algorithm 2 over the iterations, and epsilon; or the KKT residuals of
/// the active set. On a log axis with a place for zero at the bottom.
Picture convergence_picture(const results::Result& result, const results::Load& load);

/// Stages of the load whose bounds of the energy have a place in accuracy_picture.
std::size_t bounded_stages(const results::Load& load);

/// How wide the bounds of the energy and of A are over the triangles of the stages, both log; below
/// it the energy with its bounds as a band. Of at least one of bounded_stages.
Picture accuracy_picture(const results::Result& result, const results::Load& load);

/// Membrane left, traces of the first interface right: the paper's Figures 2-5.
Picture combined_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface);

}  // namespace anticrack::figures
