// SPDX-License-Identifier: GPL-3.0-or-later
//
// Counts the looks of stop/stop.hpp, stops at one of them, and measures the work between two.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <string>

#include "stop/stop.hpp"

namespace anticrack::testing {

/// Processor time of the calling thread, s: other processes do not lengthen it.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Looks {
 public:
  /// Stops at the look of this number, from 1; 0: never. Begin the work of one thread after it.
  explicit Looks(std::size_t stop_at = 0)
      : _stop_at(stop_at), _start(thread_seconds()), _last(_start) {}

  bool look(const char* doing) {
    const std::size_t number = ++_count;
    const double now = thread_seconds();
    if (now - _last > longest) {
      longest = now - _last;
      longest_before = doing;
    }
    _last = now;
    return _stop_at > 0 && number >= _stop_at;
  }
  stop::Asked asked() {
    return [this](const stop::Look& at) { return look(at.doing); };
  }
  /// The work has ended.
  void end() { look("ending"); }

  std::size_t count() const { return _count; }
  double seconds() const { return _last - _start; }
  double longest = 0;          ///< without a look, s of processor time
  std::string longest_before;  ///< what the look at its end said

 private:
  const std::size_t _stop_at;
  const double _start;
  double _last;
  std::size_t _count = 0;
};

}  // namespace anticrack::testing
