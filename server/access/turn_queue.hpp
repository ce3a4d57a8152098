// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <unordered_map>
#include <utility>

namespace anticrack::access {

/// A queue in which users take turns: the entries of a user stay in their order, and however many
/// entries one user has, another waits for at most one entry of each user. O(1). Not thread-safe.
template <class Entry>
class TurnQueue {
 public:
  void push(const std::string& user, Entry entry) {
    std::deque<Entry>& own = _entries[user];
    if (own.empty()) _users.push_back(user);
    own.push_back(std::move(entry));
    ++_size;
  }
  /// Takes the next entry; the queue must not be empty.
  Entry pop() {
    const auto own = _entries.find(_users.front());
    Entry entry = std::move(own->second.front());
    own->second.pop_front();
    if (own->second.empty())
      _entries.erase(own);
    else
      _users.push_back(own->first);
    _users.pop_front();
    --_size;
    return entry;
  }
  bool empty() const noexcept { return _size == 0; }
  std::size_t size() const noexcept { return _size; }
  /// The number of entries of one user.
  std::size_t size_of(const std::string& user) const {
    const auto own = _entries.find(user);
    return own == _entries.end() ? 0 : own->second.size();
  }

 private:
  std::unordered_map<std::string, std::deque<Entry>> _entries;
  std::deque<std::string> _users;  ///< users who have entries, the next first
  std::size_t _size = 0;
};

}  // namespace anticrack::access
