// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "output/error.hpp"

namespace anticrack::results {

/// A result that cannot be written, read or assembled.
using output::Error;

}  // namespace anticrack::results
