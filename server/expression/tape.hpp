// SPDX-License-Identifier: GPL-3.0-or-later
//
// An expression as a list of operations, each on results of earlier ones.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "expression/operations.hpp"

namespace anticrack::expression {

/// The first three compute nothing, the others are in operations.hpp: select is a != 0 ? b : c.
enum class Code : std::uint8_t {
  constant,
  x,
  y,
#define ANTICRACK_CODE(code, name, cost, value) code,
  ANTICRACK_OPERATIONS(ANTICRACK_CODE)
#undef ANTICRACK_CODE
      count
};

/// Number of an operation in its tape.
using Ref = std::int32_t;

struct Operation {
  Code code;
  std::array<Ref, 3> of;  ///< operands; -1 where there is none
  double value;           ///< of a constant
};

/// A cause of jumps or bends of the tape's value: operation `of` changes its sign or, for `steps`,
/// passes an integer.
struct Switch {
  Ref of;
  bool steps;
};

/// Operands come before the operations that use them. Equal operations are stored once, operations
/// on constants are computed when they are added, powers by small integers become products.
/// Switches come in the order of dependence: one that jumps or bends itself comes after those that
/// cause it.
class Tape {
 public:
  Ref constant(double value);
  Ref x() { return push(Code::x, -1); }
  Ref y() { return push(Code::y, -1); }
  Ref apply(Code code, Ref a, Ref b = -1, Ref c = -1);

  /// Sets the operation whose value is the expression's, and finds its switches.
  void finish(Ref result);

  const std::vector<Operation>& operations() const noexcept { return _operations; }
  const Operation& operator[](Ref of) const { return _operations[static_cast<std::size_t>(of)]; }
  /// For each operation, by number: whether one of `roots` depends on it.
  std::vector<bool> needed(std::span<const Ref> roots) const;
  Ref result() const noexcept { return _result; }
  const std::vector<Switch>& switches() const noexcept { return _switches; }

  /// Upper bound of the degree as a polynomial in x and y; `no_polynomial` if it is none, or above
  /// 20.
  int degree(Ref of) const noexcept { return _degrees[static_cast<std::size_t>(of)]; }
  static constexpr int no_polynomial = 100;
  /// The same for parts of the plane where no switch changes.
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
