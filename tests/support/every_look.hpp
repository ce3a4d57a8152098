// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hears every look (stop/stop.hpp) of all threads of a test program, whoever gave them their
// Scopes. Its program is linked by anticrack_hear_looks() of tests/CMakeLists.txt.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace anticrack::testing {

/// One at a time.
class EveryLook {
 public:
  /// At the look of this number, from 1, that says it is `doing` this, `act` is called on another
  /// thread; the look goes on when what it asks says that it is to end. Empty: only counts.
  explicit EveryLook(std::string doing = {}, std::size_t number = 0,
                     std::function<void()> act = {});
  /// Looks are heard no more.
  ~EveryLook();
  EveryLook(const EveryLook&) = delete;
  EveryLook& operator=(const EveryLook&) = delete;

  bool acted() const;
  /// How often each was done before `act`, or at all.
  std::map<std::string, std::size_t> before() const;
  /// What the looks after `act` did, each of them.
  std::vector<std::string> after() const;

  struct State;

 private:
  std::shared_ptr<State> _state;
};

}  // namespace anticrack::testing
