// SPDX-License-Identifier: GPL-3.0-or-later
//
// An interface as a picture needs it: an axis to draw over, and the parts to mark.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

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
  std::string name;              ///< of the interface, where there are several; else empty
  std::string axis;              ///< label, e.g. "x [-]"
  std::vector<double> position;  ///< (k) along the axis, increasing or decreasing
  std::vector<Band> delaminated;
  std::vector<Band> crack;
  std::vector<Band> bonded;
  std::vector<Fibre> fibres;  ///< where the result says which lie here; by Band::begin
  /// Contact, each node standing for half of its edges: their sum is the contact length, and a
  /// single node in contact can be seen.
  std::vector<Band> contact;
};

/// The axis is x or y where the interface is parallel to it (as in the paper), arc length else.
/// O(k).
Profile profile(const results::Result& result, std::size_t interface, const results::Trace& trace);

}  // namespace anticrack::figures
