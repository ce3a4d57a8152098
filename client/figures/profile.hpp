// SPDX-License-Identifier: GPL-3.0-or-later
//
// An interface for a picture: a horizontal axis, and the parts to mark.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "figures/axes.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// Stretch of an interface along the axis.
struct Band {
  double begin = 0;
  double end = 0;
};

/// A rigid inclusion, bonded and delaminated parts together.
struct Fibre {
  Band band;
  std::string inclusion;  ///< its name
};

struct Profile {
  std::string name;              ///< of the interface, if there are several
  std::string axis;              ///< label, e.g. "x [mm]"
  Scale labels;                  ///< of the axis
  std::vector<double> position;  ///< (k) along the axis, increasing or decreasing
  std::vector<Band> delaminated;
  std::vector<Band> crack;
  std::vector<Band> free;  ///< cracks without contact
  std::vector<Band> bonded;
  std::vector<Fibre> fibres;  ///< if known; by Band::begin
  /// Contact; each node covers half of its edges, so a single node is visible and the bands add up
  /// to the contact length.
  std::vector<Band> contact;
};

/// The axis is x or y if the interface is parallel to it (as in the paper), else arc length, from
/// the interface's first node, which the label names: the server may have turned the line of the
/// user. O(k).
Profile profile(const results::Result& result, std::size_t interface, const results::Trace& trace);

}  // namespace anticrack::figures
