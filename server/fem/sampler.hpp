// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <stop_token>
#include <vector>

#include "expression/function.hpp"

namespace anticrack::fem {

/// How much of the truth a set of samples tells.
enum class Trust {
  sound,
  oscillating,  ///< an argument of a sine turns too often between the samples
  singular,     ///< a divisor or the like may vanish near by: only convergence can tell
  spiking,      ///< the function may be much greater between the samples
};

/// Evaluates a function in blocks of points, counts, and looks at its stop token at every block.
/// Knows from the arguments of steep functions (exp, sin, 1/u, ...) whether samples can be trusted:
/// an argument varies smoothly where its function has a peak that no sample sees.
class Sampler {
 public:
  static constexpr std::size_t block = expression::Evaluator::block;

  Sampler(const expression::Function& function, std::stop_token stop);

  /// Values at n <= block points; both arrays are read to the next multiple of 4. Not all need be
  /// finite. Throws errors::Error (cancelled) soon after a stop was requested.
  const double* operator()(const double* x, const double* y, std::size_t n);

  /// Of the `count` points from `first` on of the last call; `room` widens what a rule of so many
  /// points can be trusted with.
  Trust trust(std::size_t first, std::size_t count, double room) const;

  /// The same of `lanes` sets of `count` points at once, the points of a set `lanes` apart.
  template <std::size_t lanes>
  void trust(std::size_t count, double room, std::array<Trust, lanes>& result) const {
    result.fill(Trust::sound);
    for (const Watch& watch : _watches) {
      const double* u = _evaluator.values(watch.root);
      std::array<double, lanes> low, high;
      for (std::size_t t = 0; t < lanes; ++t) low[t] = high[t] = u[t];
      for (std::size_t i = 1; i < count; ++i) {
        for (std::size_t t = 0; t < lanes; ++t) {
          const double value = u[i * lanes + t];
          low[t] = value < low[t] ? value : low[t];
          high[t] = high[t] < value ? value : high[t];
        }
      }
      for (std::size_t t = 0; t < lanes; ++t) {
        result[t] = std::max(result[t], judge(watch, low[t], high[t], room));
      }
    }
  }
  bool watches() const noexcept { return !_watches.empty(); }

  /// The greatest arguments of exponentials among the last call's points are kept: what is e^40
  /// below the greatest matters nowhere.
  void note_peaks(std::size_t n);

  const expression::Function& function() const noexcept { return _function; }
  std::size_t count() const noexcept { return _count; }
  double cost() const noexcept { return _evaluator.cost(); }

 private:
  enum class Kind { exponential, turning, ratio, saturating };
  struct Watch {
    std::size_t root;
    Kind kind;
    double range;  ///< what samples can be trusted with
    double peak = -std::numeric_limits<double>::infinity();
  };
  struct Roots {
    std::vector<expression::Ref> refs;
    std::vector<Watch> watches;
  };

  /// Of samples whose argument lies between two values.
  static Trust judge(const Watch& watch, double low, double high, double room);
  static Roots roots(const expression::Tape& tape);
  Sampler(const expression::Function& function, std::stop_token stop, Roots roots);

  const expression::Function& _function;
  std::stop_token _stop;
  std::vector<Watch> _watches;
  expression::Evaluator _evaluator;
  std::size_t _count = 0;
};

/// Throws errors::Error (cancelled) if a stop was requested.
void look_at(const std::stop_token& stop);

}  // namespace anticrack::fem
