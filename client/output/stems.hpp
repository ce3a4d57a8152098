// SPDX-License-Identifier: GPL-3.0-or-later
//
// File names made from names of things.
#pragma once

#include <string>
#include <vector>

namespace anticrack::output {

/// A file name stem for each name: [A-Za-z0-9][A-Za-z0-9_.-]*. No two stems, with any of `suffixes`
/// or none, are equal, ignoring case. Python's draw.files.stems gives the same.
std::vector<std::string> file_stems(const std::vector<std::string>& names,
                                    const std::vector<std::string>& suffixes);

}  // namespace anticrack::output
