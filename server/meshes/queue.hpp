// SPDX-License-Identifier: GPL-3.0-or-later
//
// The policy of which mesh is made or factorised next, without threads or locks.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>

#include "records/priority.hpp"

namespace anticrack::meshes {

/// Waiting this long is worth one class of priority.
constexpr std::chrono::seconds ageing{30};
constexpr std::size_t priority_classes = 3;

/// 0 is the most urgent.
constexpr std::size_t class_of(records::Priority priority) noexcept {
  return static_cast<std::size_t>(priority) -
         static_cast<std::size_t>(records::Priority::interactive);
}

/// The class to which something of `priority_class` has risen after waiting since `since`; at last
/// 0.
inline int urgency(std::size_t priority_class, std::chrono::steady_clock::time_point since,
                   std::chrono::steady_clock::time_point now) noexcept {
  const std::int64_t risen = static_cast<std::int64_t>(priority_class) - (now - since) / ageing;
  return static_cast<int>(std::max<std::int64_t>(0, risen));
}

/// When an owner last had something.
struct Last {
  std::chrono::steady_clock::time_point time{};
  std::uint64_t number = 0;  ///< its number in the order over all owners
};
using Lasts = std::unordered_map<std::string, Last>;
inline Last last_of(const Lasts& lasts, const std::string& owner) {
  const auto found = lasts.find(owner);
  return found == lasts.end() ? Last{} : found->second;
}

/// Contract:
/// 1. Two meshes of a class of sizes (size_class.hpp) have a thread at a time. If somebody awaits
///    the operators, they pin memory until their use begins (let_go), and a mesh begins only while
///    fewer than three are with a thread or pinned. If its owner has a name and no mesh there, up
///    to twice as many are allowed: large meshes must not delay small ones, nor those of one owner
///    those of another.
/// 2. The next mesh is the most urgent one that may begin; for this, a mesh has waited at most
///    since the last start of its owner. At equal urgency it is one of the owner who has the fewest
///    with a thread, then of the owner whose last start is longest ago, then the one that is more
///    urgent by all its waiting, then the one that came first.
/// Not thread-safe. next() is O(entries), the rest O(log entries).
class Queue {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Adds a mesh to the queue. Returns its unique number, which it keeps at its place.
  std::uint64_t add(const std::string& owner, int size_class, records::Priority priority,
                    Time since);
  /// Adds somebody with this priority who awaits it.
  void await(std::uint64_t number, records::Priority priority, Time since);
  /// Removes it from the queue; does nothing once it has begun.
  void remove(std::uint64_t number) { _waiting.erase(number); }
  /// Takes the mesh that begins now; it has a thread until done().
  std::optional<std::uint64_t> next(Time now);
  /// Adds a holder to the place, which pins the operators.
  void hold(std::uint64_t number) { ++_places.at(number).holders; }
  void let_go(std::uint64_t number);
  void done(std::uint64_t number);

 private:
  struct Waiting {
    std::string owner;
    int size_class = 0;
    bool awaited = false;
    std::array<std::optional<Time>, priority_classes> since{};  ///< the earliest wait, by class
  };
  struct Place {
    std::string owner;
    int size_class = 0;
    bool awaited = false;
    bool at_work = true;
    int holders = 0;
  };
  bool may_begin(const Waiting& one) const;

  std::uint64_t _last = 0, _starts = 0;
  std::map<std::uint64_t, Waiting> _waiting;
  std::map<std::uint64_t, Place> _places;
  Lasts _started;
};

}  // namespace anticrack::meshes
