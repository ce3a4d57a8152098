// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "growth/path.hpp"

namespace anticrack::testing {

/// A path on the line y = 0 of a structured mesh, by arc length.
inline growth::Path on_line(double from, double to, const std::string& Gc) {
  return {"sigma", {from - 1, 0}, {to - 1, 0}, Gc};
}

}  // namespace anticrack::testing
