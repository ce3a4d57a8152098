// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "expression/function.hpp"

namespace anticrack::fem {

/// Whether samples of a function show its behaviour between them.
enum class Trust {
  sound,
  unresolved,  ///< it may jump or oscillate between them; |f| is about as sampled
  singular,    ///< a divisor or the like may vanish nearby; only convergence can tell
  spiking,     ///< it may be much greater between them
};

/// The least and the greatest value of each of `lanes` sets of `count` values; values of a set are
/// `lanes` apart.
template <std::size_t lanes>
void extremes(const double* values, std::size_t count, std::array<double, lanes>& low,
              std::array<double, lanes>& high) {
  for (std::size_t t = 0; t < lanes; ++t) low[t] = high[t] = values[t];
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t t = 0; t < lanes; ++t) {
      const double value = values[i * lanes + t];
      low[t] = value < low[t] ? value : low[t];
      high[t] = high[t] < value ? value : high[t];
    }
  }
}

/// Evaluates a function in blocks of points, counts the points, and looks (stop/stop.hpp) before
/// every block. The arguments of steep functions (exp, sin, 1/u, ...) show whether samples can be
/// trusted: an argument varies smoothly where its function has a peak that the samples miss.
class Sampler {
 public:
  static constexpr std::size_t block = expression::Evaluator::block;

  /// Whether samples on both sides of a switch (Tape::switches) count as unresolved.
  enum class Jumps { ignored, watched };

  explicit Sampler(const expression::Function& function, Jumps jumps = Jumps::ignored);

  /// Values at n <= block points, which need not be finite; both arrays are read up to the next
  /// multiple of 4.
  const double* operator()(const double* x, const double* y, std::size_t n);

  /// The trust in `count` points of the last call, from `first` on; `room` is how much variation a
  /// rule with so many points can be trusted with.
  Trust trust(std::size_t first, std::size_t count, double room) const;

  /// The same for `lanes` sets of `count` points at once; points of a set are `lanes` apart.
  template <std::size_t lanes>
  void trust(std::size_t count, double room, std::array<Trust, lanes>& result) const {
    result.fill(Trust::sound);
    for (std::size_t w = 0; w < _watches.size(); ++w) {
      std::array<double, lanes> low, high;
      extremes(_evaluator.values(w + 1), count, low, high);
      for (std::size_t t = 0; t < lanes; ++t)
        raise(result[t], _watches[w], judge(_watches[w], low[t], high[t], room), t, count, lanes);
    }
  }
  bool watches() const noexcept { return !_watches.empty(); }

  /// Notes the greatest argument of each exponential over the n points of the last call: values
  /// e^40 times smaller are neglected.
  void note_peaks(std::size_t n);

  const expression::Function& function() const noexcept { return _function; }
  std::size_t count() const noexcept { return _count; }
  double cost() const noexcept { return _evaluator.cost(); }

 private:
  enum class Kind { exponential, turning, ratio, saturating, switching, stepping };
  struct Watch {
    expression::Ref argument;
    Kind kind;
    double range;  ///< most variation of the argument over samples that can be trusted
    /// The value depends on the argument only where this operation is not 0 (`taken`) or is 0, as
    /// in a branch of a ? b : c. -1: everywhere.
    expression::Ref guard = -1;
    bool taken = true;
    std::size_t guard_root = 0;  ///< number of the guard's values in the evaluator
    double peak = -std::numeric_limits<double>::infinity();
  };

  /// Whether the value depends on the watched argument at a point of the last call.
  bool applies(const Watch& watch, std::size_t point) const {
    return watch.guard < 0 || (_evaluator.values(watch.guard_root)[point] != 0) == watch.taken;
  }
  /// Raises `result` to `found` if the watch applies at one of `count` points, `step` apart.
  void raise(Trust& result, const Watch& watch, Trust found, std::size_t first, std::size_t count,
             std::size_t step) const {
    for (std::size_t i = 0; i < count && result < found; ++i)
      if (applies(watch, first + i * step)) result = found;
  }
  /// The trust in samples whose argument lies between two values.
  static Trust judge(const Watch& watch, double low, double high, double room);
  static std::vector<Watch> watches(const expression::Tape& tape, Jumps jumps);
  /// The roots to evaluate: the function, the arguments, then the guards, whose numbers are noted
  /// in the watches.
  static std::vector<expression::Ref> roots(const expression::Tape& tape,
                                            std::vector<Watch>& watches);
  Sampler(const expression::Function& function, std::vector<Watch> watches);

  const expression::Function& _function;
  std::vector<Watch> _watches;
  expression::Evaluator _evaluator;
  std::size_t _count = 0;
};

}  // namespace anticrack::fem
