// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether the work of a thread is still wanted. Whoever begins work gives it a Scope; every loop
// that can run above 10 ms looks, however deep it lies, without a token in each signature.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

namespace anticrack::stop {

/// Where the work is.
struct Look {
  const char* doing;     ///< "factorising a mesh"
  std::size_t done = 0;  ///< of what there will be, such as triangles; 0: not counted
};

/// Asked at each look of the thread; true: the work is to end. Must not throw.
using Asked = std::function<bool(const Look&)>;

/// What the looks of this thread ask while it lives, besides what they asked before.
class Scope {
 public:
  /// Until a stop is requested there.
  explicit Scope(std::stop_token token);
  /// Until `asked` says so; empty: nothing more is asked.
  explicit Scope(Asked asked);
  ~Scope();
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

 private:
  Asked _asked;
  const Asked* const _before;
};

/// What the looks of this thread ask, for a Scope of a thread that helps it.
Asked asked();

/// Throws errors::Error (cancelled), "stopped while `doing`", if the work is to end. Some
/// nanoseconds.
void look(const char* doing, std::size_t done = 0);

/// Turns of a loop over triangles, nodes or numbers that take about a millisecond.
constexpr std::size_t quick = std::size_t{1} << 16;

/// Looks each `every`-th turn of a loop, a power of two that takes about a millisecond.
template <std::size_t every = 4096>
void look_at_turn(std::size_t turn, const char* doing, std::size_t done = 0) {
  static_assert((every & (every - 1)) == 0);
  if ((turn & (every - 1)) == 0) look(doing, done);
}

}  // namespace anticrack::stop
