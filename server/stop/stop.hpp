// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tells a thread whether its work is still wanted. The code that begins work makes a Scope; every
// loop that can run above 10 ms looks, however deep it lies, without a token in each signature.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>

namespace anticrack::stop {

/// The progress of the work at a look.
struct Look {
  const char* doing;     ///< "factorising a mesh"
  std::size_t done = 0;  ///< number of things done, such as triangles; 0: not counted
};

/// Called at each look of the thread; returns true if the work is to end. Must not throw.
using Asked = std::function<bool(const Look&)>;

/// While it lives, the looks of this thread also ask this, besides what they asked before.
class Scope {
 public:
  /// Looks end the work when `token` has a stop request.
  explicit Scope(std::stop_token token);
  /// Looks end the work when `asked` returns true; empty: nothing more is asked.
  explicit Scope(Asked asked);
  ~Scope();
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;

 private:
  Asked _asked;
  const Asked* const _before;
};

/// The question that looks of this thread ask, for the Scope of a thread that helps it.
Asked asked();

/// Throws errors::Error (cancelled), "stopped while `doing`", if the work is to end. Takes some
/// nanoseconds.
void look(const char* doing, std::size_t done = 0);

/// How many turns of a quick loop over triangles, nodes or numbers take about a millisecond.
constexpr std::size_t quick = std::size_t{1} << 16;

/// Looks at every `every`-th turn of a loop; `every` is a power of two, and so many turns should
/// take about a millisecond.
template <std::size_t every = 4096>
void look_at_turn(std::size_t turn, const char* doing, std::size_t done = 0) {
  static_assert((every & (every - 1)) == 0);
  if ((turn & (every - 1)) == 0) look(doing, done);
}

}  // namespace anticrack::stop
