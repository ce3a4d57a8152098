// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/leases.hpp"

#include <utility>

namespace anticrack::group {

std::vector<Beat> Leases::silent(const std::vector<Beat>& read, Time now) {
  const bool gap = now - std::exchange(_last, now) > longest_gap;
  std::map<std::int64_t, Seen> seen;
  std::vector<Beat> result;
  for (const Beat& one : read) {
    const auto before = _seen.find(one.epoch);
    const bool same = !gap && before != _seen.end() && before->second.beats == one.beats;
    const Time since = same ? before->second.since : now;
    seen[one.epoch] = {one.beats, since};
    if (now - since >= lease) result.push_back(one);
  }
  _seen = std::move(seen);
  return result;
}

}  // namespace anticrack::group
