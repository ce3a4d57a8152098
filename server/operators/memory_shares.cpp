// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/memory_shares.hpp"

#include <algorithm>
#include <deque>
#include <map>

#include "access/share.hpp"

namespace anticrack::operators {
namespace {

using Victims = std::vector<const Resident*>;

std::uint64_t part_of_each(const Resident& one) { return one.bytes / one.owners->size(); }

bool evictable(const Resident& one) { return !one.in_use && !one.kept; }

bool used_earlier(const Resident* a, const Resident* b) { return a->last_use < b->last_use; }

/// The bytes of each owner, and the operators that can be evicted, the least recently used first.
class Holdings {
 public:
  explicit Holdings(std::span<const Resident> residents) {
    for (const Resident& one : residents)
      for (const std::string& owner : *one.owners) _bytes[owner] += part_of_each(one);
  }
  void add(const std::string& owner, std::uint64_t bytes) { _bytes[owner] += bytes; }
  void remove(const Resident& one) {
    for (const std::string& owner : *one.owners) _bytes[owner] -= part_of_each(one);
  }

  void offer(const Resident& one) { _offered[who_has_least(one)].push_back(&one); }
  void sort() {
    for (auto& [owner, own] : _offered) std::sort(own.begin(), own.end(), used_earlier);
  }
  /// Takes the next operator from the owner who has most. Owners other than `asking` must have more
  /// than `floor`. Null if there is none.
  const Resident* take(const std::string& asking, std::uint64_t floor) {
    auto most = _offered.end();
    for (auto own = _offered.begin(); own != _offered.end(); ++own) {
      const bool fair = own->first == asking || _bytes[own->first] > floor;
      if (own->second.empty() || !fair) continue;
      if (most == _offered.end() || _bytes[own->first] > _bytes[most->first]) most = own;
    }
    if (most == _offered.end()) return nullptr;
    const Resident* taken = most->second.front();
    most->second.pop_front();
    remove(*taken);
    return taken;
  }
  std::uint64_t of(const std::string& owner) { return _bytes[owner]; }

 private:
  const std::string& who_has_least(const Resident& one) {
    return *std::min_element(
        one.owners->begin(), one.owners->end(),
        [&](const std::string& a, const std::string& b) { return _bytes[a] < _bytes[b]; });
  }

  std::map<std::string, std::uint64_t> _bytes;
  std::map<std::string, std::deque<const Resident*>> _offered;
};

/// The bytes that stay even after all jobs and factorisations of the owner have ended and all the
/// owner's operators have been evicted.
std::uint64_t not_by_waiting(std::span<const Resident> residents, const std::string& owner) {
  std::uint64_t bytes = 0;
  for (const Resident& one : residents) {
    const bool goes = one.owners->contains(owner) ? !one.kept : one.stale && evictable(one);
    bytes += goes ? 0 : one.bytes;
  }
  return bytes;
}

/// Takes back evictions that are not needed, the most recently used operators first.
void spare(Victims& victims, std::uint64_t too_much) {
  std::sort(victims.begin(), victims.end(),
            [](const Resident* a, const Resident* b) { return used_earlier(b, a); });
  std::erase_if(victims, [&](const Resident* one) {
    if (one->bytes > too_much) return false;
    too_much -= one->bytes;
    return true;
  });
}

}  // namespace

PinnedShare pinned_share(std::span<const Resident> residents, const std::string& owner,
                         std::uint64_t wanted, std::uint64_t limit) {
  PinnedShare share;
  for (const Resident& one : residents) {
    share.used += evictable(one) ? 0 : one.bytes;
    if (one.in_use && !one.kept && one.owners->contains(owner)) share.own += part_of_each(one);
  }
  const bool all = owner.empty();
  share.most = all ? limit : access::share(share.own, share.used, limit);
  share.enough = access::may_have(all ? 0 : share.own, wanted, share.used, limit);
  return share;
}

std::optional<std::vector<std::string>> choose_victims(std::span<const Resident> residents,
                                                       const std::string& owner,
                                                       std::uint64_t wanted, std::uint64_t limit) {
  std::uint64_t held = wanted;
  Victims stale;
  Holdings holdings(residents);
  holdings.add(owner, wanted);
  for (const Resident& one : residents) {
    held += one.bytes;
    if (!evictable(one)) continue;
    if (one.stale)
      stale.push_back(&one);
    else
      holdings.offer(one);
  }
  Victims victims;
  std::sort(stale.begin(), stale.end(), used_earlier);
  for (const Resident* one : stale) {
    if (held <= limit) break;
    held -= one->bytes;
    holdings.remove(*one);
    victims.push_back(one);
  }
  holdings.sort();
  const bool must = wanted == 0 || wanted + not_by_waiting(residents, owner) > limit;
  while (held > limit) {
    const Resident* next = holdings.take(owner, must ? 0 : holdings.of(owner));
    if (next == nullptr) return std::nullopt;
    held -= next->bytes;
    victims.push_back(next);
  }
  spare(victims, limit - held);
  std::vector<std::string> keys;
  for (const Resident* one : victims) keys.push_back(*one->key);
  return keys;
}

}  // namespace anticrack::operators
