// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a mistyped word was meant to be.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace anticrack::casefile {

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b` (optimal
/// string alignment). O(|a| |b|).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`, upper and lower case alike, the first of equals; empty when
/// none is so near that it could be meant (more than a third of the letters differ).
std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates);

/// "did you mean theta?", or, when nothing is near, "known are epsilon, p, theta".
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace anticrack::casefile
