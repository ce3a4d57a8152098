// SPDX-License-Identifier: GPL-3.0-or-later
//
// Panels over an interface: its axis, its parts and where it is in contact. For the sources of this
// folder only.
#pragma once

#include <string>

#include "figures/axes.hpp"
#include "figures/profile.hpp"

namespace anticrack::figures {

/// Of the positions of the nodes.
Range extent(const Profile& profile);

/// Shades where the faces are in contact, behind what is drawn.
std::string contact_strips(const Profile& profile);

/// Bars at the foot for cracks and inclusions, with the names of inclusions as long as they do not
/// meet.
std::string part_bars(const Profile& profile);

/// Entries of a legend for what is marked, to go on a plot.
struct Keys {
  std::string plots;
  int count = 0;
};
Keys part_keys(const Profile& profile);

/// `range` with room for the bars and the names below, and some above.
Range with_bars(Range range, const Profile& profile);

/// Whether it has a crack or a delaminated part.
bool can_open(const results::Interface& interface);

/// The interfaces with the most to see in these loads.
struct Eventful {
  std::size_t open = 0;  ///< the largest jump, or if nothing is open the longest contact
  /// The same, if it is in contact on at least half of the longest contact; else the longest.
  std::size_t pressed = 0;
};

/// 0 and 0 without traces.
Eventful most_eventful(const results::Result& result, const std::vector<results::Load>& loads);

}  // namespace anticrack::figures
