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
  std::size_t node = 0;  ///< of the interface, in its middle
};

struct Profile {
  std::string name;              ///< of the interface, where there are several; else empty
  std::string axis;              ///< label, e.g. "x [-]"
  std::vector<double> position;  ///< (k) along the axis, increasing or decreasing
  std::vector<Band> delaminated;
  std::vector<Band> crack;
  std::vector<Band> bonded;
  std::vector<Fibre> fibres;
  /// Contact, each node standing for half of its edges: their sum is the contact length, and a
  /// single node in contact can be seen.
  std::vector<Band> contact;
};

/// The axis is x or y where the interface is parallel to it (as in the paper), arc length else.
/// O(k).
Profile profile(const results::Interface& interface, const results::Trace& trace);

}  // namespace anticrack::figures
