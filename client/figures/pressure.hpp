// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contact pressure along an interface, for a picture.
#pragma once

#include <string>
#include <vector>

#include "figures/axes.hpp"
#include "figures/canvas.hpp"
#include "figures/peaks.hpp"
#include "figures/profile.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

struct Pressure {
  std::vector<double> values;  ///< (k) NaN where there can be no contact: on glue it is a flux
  Peaks peaks;                 ///< zero without contact
};

/// The axis ends at 1.5 times what nine tenths of the contact length stay below. O(k log k).
Pressure pressure(const results::Interface& interface, const results::Trace& trace);

/// Where axes begin and end, fractions of the height of their place.
struct Box {
  double bottom = 0;
  double top = 0;
};

/// A curve, as a block of data with the columns `position`, pressure and its style.
struct PressureCurve {
  std::string block;
  std::string style;
};

/// Pressures over the interface, the contact of `profile` shaded; says what is cut off.
std::string pressure_panel(const Profile& profile, const std::vector<Pressure>& pressures,
                           const std::vector<PressureCurve>& curves, const results::Units& units,
                           const Place& place, const Box& box);

}  // namespace anticrack::figures
