// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace anticrack::app {

/// The first candidate with the smallest edit distance to `word`. `candidates` must not be empty.
/// O(total length * |word|).
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace anticrack::app
