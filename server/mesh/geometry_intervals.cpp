// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anticrack::mesh {

std::vector<int> apportion(std::span<const double> lengths, int total) {
  const std::size_t k = lengths.size();
  const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  std::vector<int> shares(k, 1);
  std::vector<double> owed(k, 0.0);  // what a curve's quota exceeds its share by
  int left = total;
  for (std::size_t i = 0; i < k; ++i) {
    const double quota = total * (lengths[i] / sum);
    // a quota that is a whole number but for rounding counts as one
    shares[i] = std::max(1, static_cast<int>(std::floor(quota + 1e-9)));
    owed[i] = quota - shares[i];
    left -= shares[i];
  }
  std::vector<std::size_t> order(k);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return owed[a] > owed[b] + 1e-9; });
  for (std::size_t i = 0; left > 0; i = (i + 1) % k, --left) ++shares[order[i]];
  // curves raised to one interval are paid for by those that have most above their quota
  while (left < 0) {
    std::size_t richest = k;
    for (std::size_t i = 0; i < k; ++i) {
      if (shares[i] < 2) continue;
      const auto above = [&](std::size_t j) { return shares[j] - total * (lengths[j] / sum); };
      if (richest == k || above(i) > above(richest) + 1e-9) richest = i;
    }
    if (richest == k) break;
    --shares[richest];
    ++left;
  }
  return shares;
}

}  // namespace anticrack::mesh
