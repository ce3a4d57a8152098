// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/order.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace anticrack::ddm {
namespace {

/// There is a way down from `upper` to `lower` that does not use `without`.
bool leads(const std::vector<Above>& conditions, std::int32_t upper, std::int32_t lower,
           const Above* without) {
  std::vector<std::int32_t> open = {upper};
  std::set<std::int32_t> seen = {upper};
  while (!open.empty()) {
    const std::int32_t here = open.back();
    open.pop_back();
    if (here == lower) return true;
    const auto first = std::lower_bound(conditions.begin(), conditions.end(), here,
                                        [](const Above& a, std::int32_t u) { return a.upper < u; });
    for (auto it = first; it != conditions.end() && it->upper == here; ++it)
      if ((without == nullptr || *it != *without) && seen.insert(it->lower).second)
        open.push_back(it->lower);
  }
  return false;
}

std::vector<Above> each_once(std::vector<Above> conditions) {
  std::sort(conditions.begin(), conditions.end());
  conditions.erase(std::unique(conditions.begin(), conditions.end()), conditions.end());
  std::erase_if(conditions, [](const Above& a) { return a.upper == a.lower; });
  return conditions;
}

}  // namespace

std::vector<Above> on_cycles(const std::vector<Above>& conditions) {
  const std::vector<Above> all = each_once(conditions);
  std::vector<Above> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result),
               [&all](const Above& a) { return leads(all, a.lower, a.upper, nullptr); });
  return result;
}

std::vector<Above> without_implied(std::vector<Above> conditions) {
  const std::vector<Above> all = each_once(std::move(conditions));
  std::vector<Above> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result),
               [&all](const Above& a) { return !leads(all, a.upper, a.lower, &a); });
  return result;
}

}  // namespace anticrack::ddm
