// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::results {

/// Writes an interval as its middle and half its width, "0.1038 +- 0.0010". The width has two
/// digits, or one at 1e-6 of the middle if it is smaller than that, and is rounded so that the
/// printed interval contains the given one. Large or small numbers are "(1.038 +- 0.010)e-5".
/// Returns "-" if an end is not finite. Python's text.interval writes the same.
std::string interval(double lower, double upper);

}  // namespace anticrack::results
