// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which mesh is made or factorised next: the policy, without threads or locks.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>

#include "meshes/urgency.hpp"
#include "store/records.hpp"

namespace anticrack::meshes {

/// Contract:
/// 1. Of a class of sizes (size_class.hpp) two have a thread at a time. Where somebody awaits the
///    operators they pin memory until he has begun with them (let_go), and one begins only while
///    fewer than three are with a thread or pinned. Up to twice as many of each if the owner has a
///    name and none there: large meshes are to hold up no small ones, and those of one owner no
///    other.
/// 2. The next is the most urgent one (urgency.hpp) that may begin, as if it had waited since the
///    last start of its owner at most; at equal urgency one of the owner who has the fewest with a
///    thread, then of who had a start longest ago, then the one that is more urgent by all its
///    waiting, then the one that came first.
/// Not thread-safe. next() is O(entries), the rest O(log entries).
class Queue {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// What is in the queue, and then at its place, by a number that no other has.
  std::uint64_t add(const std::string& owner, int size_class, store::Priority priority, Time since);
  /// Somebody with this priority awaits it (too).
  void await(std::uint64_t number, store::Priority priority, Time since);
  /// Takes it out of the queue; does nothing once it has begun.
  void remove(std::uint64_t number) { _waiting.erase(number); }
  /// The one that begins now, and has a thread until done().
  std::optional<std::uint64_t> next(Time now);
  /// Pins the operators once more.
  void hold(std::uint64_t number) { ++_places.at(number).holders; }
  void let_go(std::uint64_t number);
  void done(std::uint64_t number);

 private:
  struct Waiting {
    std::string owner;
    int size_class = 0;
    bool awaited = false;
    std::array<std::optional<Time>, priority_classes> since{};  ///< the earliest, by class
  };
  struct Place {
    std::string owner;
    int size_class = 0;
    bool awaited = false;
    bool at_work = true;
    int holders = 0;
  };
  struct Start {
    Time time{};
    std::uint64_t number = 0;
  };

  bool may_begin(const Waiting& one) const;
  Start last_start(const std::string& owner) const;

  std::uint64_t _last = 0, _starts = 0;
  std::map<std::uint64_t, Waiting> _waiting;
  std::map<std::uint64_t, Place> _places;
  std::unordered_map<std::string, Start> _started;  ///< by owner
};

}  // namespace anticrack::meshes
