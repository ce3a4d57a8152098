// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::results {

/// An interval by its middle and half its width, "0.1038 +- 0.0010": the width to two digits,
/// rounded so that the printed interval contains the given one; of a width below 1e-6 of the middle
/// one digit there. Of numbers that are large or small "(1.038 +- 0.010)e-5". "-" where an end
/// is not finite. Python's text.interval writes the same.
std::string interval(double lower, double upper);

}  // namespace anticrack::results
