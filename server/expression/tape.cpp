// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/tape.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "expression/kernels.hpp"

namespace anticrack::expression {
namespace {

constexpr int greatest_power = 16, greatest_degree = 20;

}  // namespace

Ref Tape::constant(double value) { return push(Code::constant, -1, -1, -1, value); }

bool Tape::constant_operand(Ref a) const { return a < 0 || (*this)[a].code == Code::constant; }

Ref Tape::apply(Code code, Ref a, Ref b, Ref c) {
  const auto value = [this](Ref of) { return (*this)[of].value; };
  if (constant_operand(a) && constant_operand(b) && constant_operand(c)) {
    std::array<double, 3> operands{value(a), b < 0 ? 0 : value(b), c < 0 ? 0 : value(c)};
    double result = 0;
    plain_kernels[static_cast<std::size_t>(code)](&operands[0], &operands[1], &operands[2], &result,
                                                  1);
    return constant(result);
  }
  if (code == Code::select && constant_operand(a)) return value(a) != 0 ? b : c;
  if (code == Code::select && b == c) return b;
  if (code == Code::power && constant_operand(b)) {
    const double exponent = value(b);
    if (exponent == 0.5) return push(Code::square_root, a);
    if (std::abs(exponent) <= greatest_power && exponent == std::floor(exponent)) {
      const Ref power = integer_power(a, static_cast<int>(std::abs(exponent)));
      return exponent < 0 ? push(Code::divide, constant(1), power) : power;
    }
  }
  return push(code, a, b, c);
}

Ref Tape::integer_power(Ref base, int exponent) {
  if (exponent == 0) return constant(1);
  const Ref half = exponent / 2 > 0 ? integer_power(base, exponent / 2) : -1;
  const Ref even = half < 0 ? -1 : push(Code::multiply, half, half);
  return exponent % 2 == 0 ? even : even < 0 ? base : push(Code::multiply, even, base);
}

void Tape::note_switches(const Operation& operation) {
  const auto [a, b, c] = operation.of;
  const auto zero = [this](Ref of) {
    const Operation& one = (*this)[of];
    return one.code == Code::constant && one.value == 0;
  };
  switch (operation.code) {
    case Code::less:
    case Code::less_equal:
    case Code::minimum:
    case Code::maximum:
      note_sign(zero(a) ? b : zero(b) ? a : push(Code::subtract, std::min(a, b), std::max(a, b)));
      break;
    case Code::absolute:
    case Code::sign:
    case Code::arc_tangent2:  // jumps where its first operand, y, passes zero
      note_sign(a);
      break;
    case Code::nearest:
      note({push(Code::add, a, constant(0.5)), true});
      break;
    case Code::lower:
    case Code::upper:
      note({a, true});
      break;
    default:
      break;
  }
}

/// The factors of a product change their signs along simpler lines than the product. sin(u) changes
/// its sign where u / pi passes an integer.
void Tape::note_sign(Ref of) {
  const Operation operation = (*this)[of];
  const auto [a, b, c] = operation.of;
  switch (operation.code) {
    case Code::multiply:
    case Code::divide:
      note_sign(b);
      [[fallthrough]];
    case Code::negate:
      note_sign(a);
      break;
    case Code::sine:
    case Code::cosine: {
      const Ref turns = push(Code::divide, a, constant(std::numbers::pi));
      const bool sine = operation.code == Code::sine;
      note({sine ? turns : push(Code::add, turns, constant(0.5)), true});
      break;
    }
    default:
      note({of, false});
  }
}

void Tape::note(const Switch& one) {
  const bool known = std::any_of(_switches.begin(), _switches.end(), [&](const Switch& other) {
    return other.of == one.of && other.steps == one.steps;
  });
  if (!known && !constant_operand(one.of)) _switches.push_back(one);
}

Ref Tape::push(Code code, Ref a, Ref b, Ref c, double value) {
  if ((code == Code::add || code == Code::multiply) && b < a) std::swap(a, b);
  const auto [known, added] = _known.try_emplace(
      {code, a, b, c, std::bit_cast<std::uint64_t>(value)}, static_cast<Ref>(_operations.size()));
  if (added) {
    _operations.push_back({code, {a, b, c}, value});
    _degrees.push_back(degree(_operations.back(), _degrees));
    _pieces.push_back(degree_of_piece(_operations.back()));
  }
  return known->second;
}

int Tape::degree(const Operation& operation, const std::vector<int>& degrees) const {
  const auto of = [&](std::size_t i) { return degrees[static_cast<std::size_t>(operation.of[i])]; };
  int result = no_polynomial;
  switch (operation.code) {
    case Code::constant:
      return std::isfinite(operation.value) ? 0 : no_polynomial;
    case Code::x:
    case Code::y:
      return 1;
    case Code::add:
    case Code::subtract:
      result = std::max(of(0), of(1));
      break;
    case Code::multiply:
      result = of(0) + of(1);
      break;
    case Code::divide:
      result = constant_operand(operation.of[1]) ? of(0) : no_polynomial;
      break;
    case Code::negate:
      result = of(0);
      break;
    default:
      break;
  }
  return result > greatest_degree ? no_polynomial : result;
}

int Tape::degree_of_piece(const Operation& operation) const {
  const auto of = [&](std::size_t i) { return _pieces[static_cast<std::size_t>(operation.of[i])]; };
  switch (operation.code) {
    case Code::absolute:
      return of(0);
    case Code::minimum:
    case Code::maximum:
      return std::max(of(0), of(1));
    case Code::select:
      return std::max(of(1), of(2));
    case Code::nearest:
    case Code::lower:
    case Code::upper:
    case Code::sign:
    case Code::less:
    case Code::less_equal:
    case Code::equal:
    case Code::unequal:
    case Code::both:
    case Code::either:
      return 0;
    default:
      return degree(operation, _pieces);
  }
}

std::vector<bool> Tape::needed(std::span<const Ref> roots) const {
  std::vector<bool> result(_operations.size(), false);
  for (const Ref root : roots) result[static_cast<std::size_t>(root)] = true;
  for (std::size_t i = result.size(); i-- > 0;) {
    for (const Ref of : _operations[i].of)
      if (result[i] && of >= 0) result[static_cast<std::size_t>(of)] = true;
  }
  return result;
}

void Tape::finish(Ref result) {
  _result = result;
  const std::vector<bool> used = needed({&result, 1});
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) note_switches(Operation(_operations[i]));
}

}  // namespace anticrack::expression
