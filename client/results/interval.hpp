// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::results {

/// Writes a value, the middle of its bounds, and how far they are from it: "0.1038 +- 0.0010". The
/// distance has two digits, or one at 1e-6 of the value if it is smaller than that, and is rounded
/// so that the printed interval contains the bounds. Large or small numbers are
/// "(1.038 +- 0.010)e-5". Returns "-" if a bound is not finite. Python's text.interval writes the
/// same.
std::string interval(double value, double lower, double upper);

}  // namespace anticrack::results
