// SPDX-License-Identifier: GPL-3.0-or-later
//
// Text that came from outside, made fit to be sent in an error or written to a log.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace anticrack::api {

/// `text` as valid UTF-8 of at most `max_bytes` (>= 3): control characters and broken sequences
/// become '?', what is too long is cut between characters and ends in "...". O(n).
std::string printable(std::string_view text, std::size_t max_bytes);

/// Whether it is well-formed. O(n).
bool is_utf8(std::string_view text);

}  // namespace anticrack::api
