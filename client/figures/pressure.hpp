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

/// The nodal pressures of a result, forces over lengths, go up and down from node to node with the
/// number of triangles there. Drawn is the mean over each edge, half of which belongs to either
/// node: the force is the same.
struct Pressure {
  std::vector<double> position;  ///< middles of the edges; at a tip of the half that is no tip's
  std::vector<double> values;    ///< NaN between cracks: on glue it is a flux
  std::vector<double> lengths;   ///< times the values: the force [F]
  Peaks peaks;                   ///< zero without contact
};

/// `position`: of the nodes along the axis. The axis of the values ends at 1.5 times what nine
/// tenths of the contact length stay below. O(k log k).
Pressure pressure(const results::Interface& interface, const results::Trace& trace,
                  const std::vector<double>& position);

/// Where axes begin and end, fractions of the height of their place.
struct Box {
  double bottom = 0;
  double top = 0;
};

/// A curve, as a block of data with the columns `position` and `values` of a Pressure, and its
/// style.
struct PressureCurve {
  std::string block;
  std::string style;
};

/// Pressures over the interface, the contact of `profile` shaded; says what is cut off.
std::string pressure_panel(const Profile& profile, const std::vector<Pressure>& pressures,
                           const std::vector<PressureCurve>& curves, const results::Units& units,
                           const Place& place, const Box& box);

}  // namespace anticrack::figures
