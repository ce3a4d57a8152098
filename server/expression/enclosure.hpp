// SPDX-License-Identifier: GPL-3.0-or-later
//
// What an expression and its derivatives can be over a box, proved by interval arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "expression/interval.hpp"
#include "expression/tape.hpp"

namespace anticrack::expression {

/// Intervals that hold the coefficients d^(i+j) f / dx^i dy^j / (i! j!) in every point of a box, i
/// + j
/// <= order <= 4. By ascending degree, of x first: 1, x, y, x^2, x y, y^2, x^3, ..., y^4. Where f
/// has a kink, the first derivatives hold those of all its sides, so that the mean value theorem
/// holds.
struct Jet {
  static constexpr int most = 4;
  static constexpr std::size_t size = 15;

  std::array<Interval, size> of{};
  int order = most;  ///< those of higher degree are unknown; 0: only the values are known
  int degree = 0;    ///< all of higher degree are 0
  /// Whether it has a value everywhere: the operands of all functions lie in their domains. If not,
  /// of the part of the box where it has one.
  bool defined = true;

  const Interval& value() const noexcept { return of[0]; }
};

/// Encloses the result of a tape over boxes. Belongs to one thread. Elementary functions are those
/// of the C library, taken to be wrong by at most 4 units in the last place.
class Enclosure {
 public:
  explicit Enclosure(const Tape& tape);

  /// A comparison, a step or a kink that has two sides in a box.
  struct Choice {
    Ref of;
    double level;        ///< of steps: the whole number that is passed
    bool above = false;  ///< the side that is taken: where its argument is above 0, or below
  };

  /// Over a box, up to `order`, with the sides taken that are given. O(operations).
  const Jet& operator()(const Interval& x, const Interval& y, int order,
                        std::span<const Choice> taken = {});

  /// The first choice in the box that is open and on which the last result depends. None: there is
  /// none, or one with more than two sides.
  std::optional<Choice> choice() const;
  /// The argument of the last of the choices that were given.
  const Jet& argument() const noexcept { return _argument; }

  /// Time of a box, roughly, ns.
  double cost() const noexcept { return 120 * static_cast<double>(_needed.size()); }

 private:
  Jet apply(Ref number, const Operation& operation);
  /// Whether it is not constant on any line along a side of the box: then it has any given value on
  /// a set without area, or without length where the box is a line.
  bool slopes(const Jet& a) const noexcept;
  /// Whether an operand counts as true. What is 0 on a set without area does.
  enum class Truth { no, yes, unknown };
  Truth truth(const Jet& a) const noexcept;
  /// Of an operation whose side is given; null: of another one.
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
    bool two;  ///< two sides
    double level;
  };
  std::vector<Undecided> _undecided;
  Interval _x, _y;
  int _order = Jet::most;
  std::span<const Choice> _taken;
  Jet _argument;
};

}  // namespace anticrack::expression
