// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "expression/tape.hpp"

namespace anticrack::expression {

/// Reads an expression in x and y: muParser's syntax and functions with floor and ceil, and the
/// constants _pi and _e. Throws errors::Error (expression_invalid, at `field`) on a syntax error,
/// an unknown symbol, an assignment, a string or a list of values. O(length) operations.
Tape parse(const std::string& text, const std::string& field);

}  // namespace anticrack::expression
