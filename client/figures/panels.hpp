// SPDX-License-Identifier: GPL-3.0-or-later
//
// For each kind of panel its data blocks and the commands that draw it into a part of the picture.
// Colours are safe for colour-blind readers (Okabe & Ito; viridis).
#pragma once

#include <string>
#include <utility>

#include "figures/figures.hpp"
#include "figures/profile.hpp"
#include "figures/surface.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// Part of the picture, fractions from its lower left corner.
struct Place {
  double x = 0;
  double y = 0;
  double width = 1;
  double height = 1;
};

/// The left and the right half.
inline std::pair<Place, Place> halves(const Place& place) {
  const double half = place.width / 2;
  return {{place.x, place.y, half, place.height}, {place.x + half, place.y, half, place.height}};
}

/// Degrees about the vertical. The view is over the minus side at the interface: the crack opens
/// upwards on the far side ([u] >= 0).
double membrane_view(const results::Result& result);

/// The surface over the plane, seen from `view` degrees.
std::string membrane_data(const Surface& surface);
std::string membrane_panel(const Surface& surface, const results::Load& load, double view,
                           const Place& place, Format format);

/// u on both sides of an interface over its arc length, and where it is in contact.
std::string traces_data(const Profile& profile, const results::Trace& trace);
std::string traces_panel(const Profile& profile, const results::Trace& trace,
                         const results::Load& load, const Place& place);

/// The criterion of Algorithm 2, or the KKT residuals of the active set, on a log axis with a place
/// for zero at the bottom.
std::string convergence_data(const results::Load& load);
std::string convergence_panel(const results::Load& load, const Place& place);

}  // namespace anticrack::figures
