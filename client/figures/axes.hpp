// SPDX-License-Identifier: GPL-3.0-or-later
//
// What panels of curves have in common: colours, margins, labels. For the sources of this folder
// only.
#pragma once

#include <string>

#include "figures/panels.hpp"

namespace anticrack::figures {

// Okabe & Ito; the curves differ in dash as well, for print without colour.
inline const std::string blue = "rgb '#0072B2'";
inline const std::string vermillion = "rgb '#D55E00'";
inline const std::string black = "rgb '#222222'";
inline const std::string contact_shade = "rgb '#F0E442'";

/// Where the axes stand, fractions of the place.
std::string margins(const Place& place, double left, double right, double bottom, double top);

/// Above the axes.
std::string caption(const std::string& text, const Place& place);

/// Label of the horizontal axis at a height of the place: terminals measure the distance `set
/// xlabel` keeps in characters of different sizes.
std::string below(const std::string& quoted_text, double height, const Place& place);

/// Commands: how axes, tics and grid look in all figures.
std::string axes();

}  // namespace anticrack::figures
