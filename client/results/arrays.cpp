// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/arrays.hpp"

#include <algorithm>

namespace anticrack::results {

bool fits(const Shape& shape, std::string_view wanted, Extents& known) {
  for (const std::uint64_t extent : shape) {
    const std::string word(wanted.substr(0, wanted.find(',')));
    wanted.remove_prefix(std::min(word.size() + 1, wanted.size()));
    const bool number = !word.empty() && word[0] >= '0' && word[0] <= '9';  // of one digit
    if (word.empty() || extent != (number ? static_cast<std::uint64_t>(word[0] - '0')
                                          : known.try_emplace(word, extent).first->second))
      return false;
  }
  return wanted.empty();
}

}  // namespace anticrack::results
