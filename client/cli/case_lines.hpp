// SPDX-License-Identifier: GPL-3.0-or-later
//
// One line per load case of a job. Pure.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/progress.hpp"

namespace anticrack::cli {

/// At most `height` lines, at least 1, of at most `width` columns; see frame.
std::vector<std::string> case_lines(const JobProgress& progress, std::size_t width,
                                    std::size_t height);

inline constexpr std::size_t bar_room = 12;  ///< fewest columns of a bar
/// "  [####----]", `fraction` of it full, in at most `room` columns, at least bar_room.
std::string bar(double fraction, std::size_t room);

}  // namespace anticrack::cli
