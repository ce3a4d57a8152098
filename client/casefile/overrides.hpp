// SPDX-License-Identifier: GPL-3.0-or-later
//
// --set key=value. For the sources of this folder only.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace anticrack::casefile {

/// Writes the value of "key=value" into the case. The key is a dotted path, entries of arrays by
/// index from 0 (an index one past the end appends a table) or, where all have one, by `name`;
/// missing tables are made. The value is TOML; what is not a TOML value is text, so that quotes may
/// be left out. Throws Error for a key that leads nowhere, and for control characters and what is
/// not UTF-8.
void apply_override(toml::table& root, const std::string& assignment);

}  // namespace anticrack::casefile
