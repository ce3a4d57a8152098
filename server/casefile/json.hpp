// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <toml++/toml.h>

#include <string>

namespace anticrack::casefile {

/// The tables of a case from one JSON object: objects become tables, lists arrays, whole numbers
/// integers. The nodes have no source. Throws Error, with `source`, for other texts, for null, and
/// for values that lie deeper than any key of a case. Linear in the text.
toml::table tables_of_json(const std::string& text, const std::string& source);

}  // namespace anticrack::casefile
