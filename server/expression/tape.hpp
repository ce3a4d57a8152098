// SPDX-License-Identifier: GPL-3.0-or-later
//
// An expression as a list of operations, each on results of earlier ones.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace anticrack::expression {

/// The order is that of the table of kernels; the first three compute nothing.
enum class Code : std::uint8_t {
  constant,
  x,
  y,
  add,
  subtract,
  multiply,
  divide,
  negate,
  power,
  square_root,
  exponential,
  logarithm,
  logarithm2,
  logarithm10,
  sine,
  cosine,
  tangent,
  arc_sine,
  arc_cosine,
  arc_tangent,
  hyperbolic_sine,
  hyperbolic_cosine,
  hyperbolic_tangent,
  area_sine,
  area_cosine,
  area_tangent,
  arc_tangent2,
  absolute,
  minimum,
  maximum,
  nearest,  ///< floor(a + 1/2)
  lower,    ///< floor
  upper,    ///< ceil
  sign,
  less,
  less_equal,
  equal,
  unequal,
  both,    ///< &&
  either,  ///< ||
  select,  ///< a != 0 ? b : c
  count
};

/// Number of an operation in its tape.
using Ref = std::int32_t;

struct Operation {
  Code code;
  std::array<Ref, 3> of;  ///< operands; -1 where there is none
  double value;           ///< of a constant
};

/// Where the tape's value may jump or bend: where operation `of` changes its sign or, for `steps`,
/// passes an integer.
struct Switch {
  Ref of;
  bool steps;
};

/// Operands come before what uses them. Equal operations are one, those of constants are computed
/// at once, powers by small integers are products. Switches are in the order of dependence: one
/// that jumps or bends itself comes after those that make it do so.
class Tape {
 public:
  Ref constant(double value);
  Ref x() { return push(Code::x, -1); }
  Ref y() { return push(Code::y, -1); }
  Ref apply(Code code, Ref a, Ref b = -1, Ref c = -1);

  /// Declares the value of the whole and looks for its switches.
  void finish(Ref result);

  const std::vector<Operation>& operations() const noexcept { return _operations; }
  Ref result() const noexcept { return _result; }
  const std::vector<Switch>& switches() const noexcept { return _switches; }

  /// Degree as a polynomial in x and y, at most; `no_polynomial` where it is none, or above 20.
  int degree(Ref of) const noexcept { return _degrees[static_cast<std::size_t>(of)]; }
  static constexpr int no_polynomial = 100;
  /// The same where no switch changes.
  int degree_between_switches(Ref of) const noexcept {
    return _pieces[static_cast<std::size_t>(of)];
  }

 private:
  using Key = std::tuple<Code, Ref, Ref, Ref, std::uint64_t>;

  Ref push(Code code, Ref a, Ref b = -1, Ref c = -1, double value = 0);
  Ref integer_power(Ref base, int exponent);
  void note_switches(const Operation& operation);
  void note_sign(Ref of);
  void note(const Switch& one);
  bool constant_operand(Ref a) const;
  /// `of`: degrees of the operations so far.
  int degree(const Operation& operation, const std::vector<int>& of) const;
  int degree_of_piece(const Operation& operation) const;

  std::vector<Operation> _operations;
  std::vector<int> _degrees, _pieces;
  std::vector<Switch> _switches;
  std::map<Key, Ref> _known;
  Ref _result = -1;
};

}  // namespace anticrack::expression
