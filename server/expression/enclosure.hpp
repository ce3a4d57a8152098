// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of an expression and its derivatives over a box, proved by interval arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "expression/interval.hpp"
#include "expression/tape.hpp"

namespace anticrack::expression {

/// Intervals that hold the coefficients d^(i+j) f / dx^i dy^j / (i! j!) at every point of a box, i
/// + j <= order <= 4, by ascending degree, powers of x first: 1, x, y, x^2, x y, y^2, x^3, ...,
/// y^4. If f has a kink, the first derivatives hold those of all its sides, so that the mean value
/// theorem is valid.
struct Jet {
  static constexpr int most = 4;
  static constexpr std::size_t size = 15;

  std::array<Interval, size> of{};
  int order = most;  ///< coefficients above are unknown; 0: only the values are known
  int degree = 0;    ///< all coefficients above are 0
  /// Whether f has a value everywhere, as the operands of all functions lie in their domains. If
  /// not, the intervals are for the part of the box where f has a value.
  bool defined = true;

  const Interval& value() const noexcept { return of[0]; }
};

/// Encloses the result of a tape over boxes. Belongs to one thread. Elementary functions are those
/// of the C library, assumed to be wrong by at most 4 units in the last place.
class Enclosure {
 public:
  explicit Enclosure(const Tape& tape);

  /// A comparison, a step or a kink that has two sides in a box.
  struct Choice {
    Ref of;
    double level;        ///< for steps: the whole number that is passed
    bool above = false;  ///< the side taken: where the argument is above 0, or below
  };

  /// Encloses the result over a box, up to `order`, with the given sides taken. O(operations).
  const Jet& operator()(const Interval& x, const Interval& y, int order,
                        std::span<const Choice> taken = {});

  /// The first open choice in the box on which the last result depends. None if there is no such
  /// choice, or one with more than two sides.
  std::optional<Choice> choice() const;
  /// The argument of the last of the given choices.
  const Jet& argument() const noexcept { return _argument; }

  /// Time that a box takes, roughly, in ns.
  double cost() const noexcept { return 120 * static_cast<double>(_needed.size()); }

 private:
  Jet apply(Ref number, const Operation& operation);
  /// Whether `a` is constant on no line along a side of the box. Then it takes any given value on a
  /// set without area at most, or without length if the box is a line.
  bool slopes(const Jet& a) const noexcept;
  /// Whether an operand counts as true; one that is 0 only on a set without area does.
  enum class Truth { no, yes, unknown };
  Truth truth(const Jet& a) const noexcept;
  /// The given choice of an operation; null if its side is not given.
  const Choice* given(Ref number) const;
  Jet take(const Choice& choice, const Jet& argument, const Jet& below, const Jet& above);
  Jet two_ways(Ref number, const Jet& below, const Jet& above, bool continuous, double level = 0);
  Jet steps(Ref number, const Jet& a, bool up);
  Jet compare(Ref number, const Operation& operation);
  Jet quadrant(Ref number, const Jet& y, const Jet& x);
  Jet undecided(Ref number, const Interval& values);

  const Tape& _tape;
  std::vector<Ref> _needed;
  std::vector<Jet> _jets;
  struct Undecided {
    Ref of;
    bool two;  ///< whether it has two sides
    double level;
  };
  std::vector<Undecided> _undecided;
  Interval _x, _y;
  int _order = Jet::most;
  std::span<const Choice> _taken;
  Jet _argument;
};

}  // namespace anticrack::expression
