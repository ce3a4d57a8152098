// SPDX-License-Identifier: GPL-3.0-or-later
//
// The figures of a load as pure functions of the result. Colours are safe for colour-blind readers
// (Okabe & Ito; viridis). The gnuplot scripts hold numbers, fixed text and strings made by
// `quoted`; the only file they name is that of `Output`. A Picture refers to the arguments it was
// made of.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/interface_axis.hpp"
#include "figures/pressure.hpp"
#include "figures/surface.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// Degrees about the vertical. Where interfaces are parallel, the view is over their minus side:
/// the cracks open upwards on the far side ([u] >= 0).
double membrane_view(const results::Result& result);

/// Deformed membrane, slit open.
Picture membrane_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface);

/// The range of u+, u-, [u] and zero. If these are rounding errors compared with u on the membrane,
/// estimated from Pi(u), the range of u, so that zero looks like zero.
Range heights(const std::vector<const results::Trace*>& traces, double energy);

/// What there is to see along an interface, to be put into a picture.
struct TracesPanels {
  std::string data, pressure_data;
  std::function<std::string(const Place&, const Box&)> displacements, pressure;
  std::function<std::string(double height, const Place&)> axis_label;
  std::string name;         ///< of the interface, if there are several
  bool in_contact = false;  ///< else there is no pressure to draw
};

TracesPanels traces_panels(const results::Result& result, const results::Load& load,
                           std::size_t interface);

/// u-, u+ and [u] along an interface; where it is in contact, shaded, the pressure below.
Picture traces_picture(const results::Result& result, const results::Load& load,
                       std::size_t interface);

/// Load cases laid over each other.
inline constexpr std::size_t together_limit = 8;

/// [u], u- and u+ and, where there is contact, the pressure along an interface, a colour for each
/// load. Of at most together_limit loads, all with traces.
Picture together_picture(const results::Result& result, std::size_t interface);

/// More than two iterations: of two the line says nothing.
bool has_convergence(const results::Load& load);

/// The criterion of step 3 of Algorithm 2 over the iterations, and epsilon; or the KKT residuals of
/// the active set. On a log axis with a place for zero at the bottom.
Picture convergence_picture(const results::Result& result, const results::Load& load);

/// Stages of the load whose bounds of the energy have a place in accuracy_picture.
std::size_t bounded_stages(const results::Load& load);

/// How wide the bounds of the energy and of A are over the triangles of the stages, both log; below
/// it the energy with its bounds as a band. Of at least one of bounded_stages.
Picture accuracy_picture(const results::Result& result, const results::Load& load);

/// The upper panel of accuracy_picture.
Picture errors_picture(const results::Result& result, const results::Load& load);

/// From above: lines of u over |T grad u| in colours, cracks, inclusions and the sides that came
/// off.
Picture plan_picture(const results::Result& result, const results::Load& load,
                     const Surface& surface);

/// Membrane left, traces of an interface right, as in the paper's Figures 2-5. Where there is
/// something for it, a second row: the plan, and the first that there is of the contact pressure,
/// the bounds of an accuracy and the convergence.
Picture overview_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface, const Eventful& interfaces);

}  // namespace anticrack::figures
