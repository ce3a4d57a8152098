// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace anticrack::figures {

/// gnuplot's SVG without its empty groups: it opens some for every triangle, which is most of the
/// file and slow to show. Works on gnuplot's lines, one tag at the beginning of each. O(length).
std::string without_empty_groups(std::string_view svg);

}  // namespace anticrack::figures
