// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/queue.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace anticrack::meshes {

namespace {

constexpr int at_work_at_once = 2, ahead_at_once = 3;  // of one class of sizes

}  // namespace

std::uint64_t Queue::add(const std::string& owner, int size_class, records::Priority priority,
                         Time since) {
  _waiting[++_last] = {owner, size_class};
  _waiting[_last].since[class_of(priority)] = since;
  return _last;
}

void Queue::await(std::uint64_t number, records::Priority priority, Time since) {
  if (const auto begun = _places.find(number); begun != _places.end()) begun->second.awaited = true;
  const auto found = _waiting.find(number);
  if (found == _waiting.end()) return;
  std::optional<Time>& earliest = found->second.since[class_of(priority)];
  earliest = earliest ? std::min(*earliest, since) : since;
  found->second.awaited = true;
}

bool Queue::may_begin(const Waiting& one) const {
  int at_work = 0, ahead = 0;
  bool own_at_work = false, own = false;
  for (const auto& [number, place] : _places) {
    if (place.size_class != one.size_class) continue;
    const bool is_own = place.owner == one.owner;
    if (place.at_work) {
      ++at_work;
      own_at_work = own_at_work || is_own;
    }
    if (place.awaited || place.holders > 0) {
      ++ahead;
      own = own || is_own;
    }
  }
  const auto most = [&](int limit, bool has_one) {
    return one.owner.empty() || has_one ? limit : 2 * limit;
  };
  return at_work < most(at_work_at_once, own_at_work) &&
         (!one.awaited || ahead < most(ahead_at_once, own));
}

std::optional<std::uint64_t> Queue::next(Time now) {
  using Rank = std::tuple<int, std::ptrdiff_t, std::uint64_t, int>;
  auto best = _waiting.end();
  Rank best_rank;
  for (auto one = _waiting.begin(); one != _waiting.end(); ++one) {
    const Waiting& waiting = one->second;
    if (!may_begin(waiting)) continue;
    const Last last = last_of(_started, waiting.owner);
    int since_start = std::numeric_limits<int>::max(), in_all = since_start;
    for (std::size_t priority = 0; priority < priority_classes; ++priority) {
      if (!waiting.since[priority]) continue;
      const Time since = *waiting.since[priority];
      since_start = std::min(since_start, urgency(priority, std::max(since, last.time), now));
      in_all = std::min(in_all, urgency(priority, since, now));
    }
    const auto own = std::ranges::count_if(_places, [&](const auto& place) {
      return place.second.at_work && place.second.owner == waiting.owner;
    });
    const Rank rank{since_start, own, last.number, in_all};
    if (best == _waiting.end() || rank < best_rank) {
      best = one;
      best_rank = rank;
    }
  }
  if (best == _waiting.end()) return std::nullopt;
  const std::uint64_t number = best->first;
  _started[best->second.owner] = {now, ++_starts};
  _places[number] = {best->second.owner, best->second.size_class, best->second.awaited};
  _waiting.erase(best);
  return number;
}

void Queue::let_go(std::uint64_t number) {
  const auto found = _places.find(number);
  if (--found->second.holders == 0 && !found->second.at_work) _places.erase(found);
}

void Queue::done(std::uint64_t number) {
  const auto found = _places.find(number);
  found->second.at_work = false;
  if (found->second.holders == 0) _places.erase(found);
}

}  // namespace anticrack::meshes
