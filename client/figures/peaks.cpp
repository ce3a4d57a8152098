// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/peaks.hpp"

#include <algorithm>
#include <iterator>

namespace anticrack::figures {

Peaks peaks(std::vector<std::pair<double, double>> weighted, double part, double room) {
  if (weighted.empty()) return {};
  std::ranges::sort(weighted);
  double all = 0, below = 0;
  for (const auto& [value, weight] : weighted) all += weight;
  auto at = weighted.begin();
  while (std::next(at) != weighted.end() && (below += at->second) < part * all) ++at;
  constexpr double little = 1.25;
  const double highest = weighted.back().first;
  const double shown = room * at->first;
  return {highest, highest <= little * shown ? std::max(shown, highest) : shown};
}

}  // namespace anticrack::figures
