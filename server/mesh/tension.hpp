// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "fields/fields.hpp"

namespace anticrack::mesh {

/// A tension that varies or differs between two directions: in -div(T grad u) = f the symmetric
/// matrix T has the eigenvalue `along` in the direction `angle` and `across` perpendicular to it.
struct TensionLaw {
  std::string along;   ///< expression in x and y, > 0, force per length; empty: no law
  std::string across;  ///< the same; empty: equal to `along`
  double angle = 0;    ///< degrees, counterclockwise from the x axis
  bool operator==(const TensionLaw&) const = default;
};
ANTICRACK_FIELDS(TensionLaw, along, across, angle)

/// The fault of a law, with the cure, or empty. Does not look at its expressions.
std::string fault_of(const TensionLaw& law);

}  // namespace anticrack::mesh
