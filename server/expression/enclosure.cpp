// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/enclosure.hpp"

#include <algorithm>
#include <numbers>

#include "expression/jet.hpp"

namespace anticrack::expression {
namespace {

Jet exactly(double value) { return constant_jet({value, value}); }

}  // namespace

bool Enclosure::slopes(const Jet& a) const noexcept {
  return a.order >= 1 &&
         ((_x.low < _x.high && !a.of[1].holds(0)) || (_y.low < _y.high && !a.of[2].holds(0)));
}

Enclosure::Truth Enclosure::truth(const Jet& a) const noexcept {
  if (!a.defined) return Truth::unknown;  // an operand without a value counts as true
  if (a.value().is(0)) return Truth::no;
  return !a.value().holds(0) || slopes(a) ? Truth::yes : Truth::unknown;
}

Enclosure::Enclosure(const Tape& tape) : _tape(tape), _jets(tape.operations().size()) {
  const Ref result = tape.result();
  const std::vector<bool> needed = tape.needed({&result, 1});
  for (std::size_t i = 0; i < needed.size(); ++i)
    if (needed[i]) _needed.push_back(static_cast<Ref>(i));
}

const Jet& Enclosure::operator()(const Interval& x, const Interval& y, int order,
                                 std::span<const Choice> taken) {
  _x = x;
  _y = y;
  _order = order;
  _taken = taken;
  _undecided.clear();
  for (const Ref number : _needed)
    _jets[static_cast<std::size_t>(number)] = apply(number, _tape[number]);
  return _jets[static_cast<std::size_t>(_tape.result())];
}

std::optional<Enclosure::Choice> Enclosure::choice() const {
  if (_undecided.empty()) return std::nullopt;
  // Go backwards through the operations on which the result depends in this box.
  std::vector<bool> matters(_jets.size(), false);
  matters[static_cast<std::size_t>(_tape.result())] = true;
  const auto need = [&](Ref of) { matters[static_cast<std::size_t>(of)] = true; };
  const auto jet = [&](Ref of) -> const Jet& { return _jets[static_cast<std::size_t>(of)]; };
  for (auto number = _needed.rbegin(); number != _needed.rend(); ++number) {
    if (!matters[static_cast<std::size_t>(*number)]) continue;
    const auto& [code, of, value] = _tape[*number];
    if (code == Code::select && truth(jet(of[0])) != Truth::unknown) {
      need(of[0]);
      need(truth(jet(of[0])) == Truth::yes ? of[1] : of[2]);
      continue;
    }
    if (code == Code::both || code == Code::either) {  // one operand may decide alone
      const Truth deciding = code == Code::both ? Truth::no : Truth::yes;
      const bool first = truth(jet(of[0])) == deciding, second = truth(jet(of[1])) == deciding;
      if (first || second) {
        need(first ? of[0] : of[1]);
        continue;
      }
    }
    for (const Ref operand : of)
      if (operand >= 0) need(operand);
  }
  const Undecided* first = nullptr;
  for (const Undecided& one : _undecided) {
    if (!matters[static_cast<std::size_t>(one.of)]) continue;
    if (!one.two) return std::nullopt;
    if (first == nullptr) first = &one;
  }
  if (first == nullptr) return std::nullopt;
  return Choice{first->of, first->level};
}

Jet Enclosure::undecided(Ref number, const Interval& values) {
  _undecided.push_back({number, false, 0});
  Jet result = constant_jet(values);
  result.order = 0;
  result.degree = Jet::most;
  return result;
}

const Enclosure::Choice* Enclosure::given(Ref number) const {
  for (const Choice& one : _taken)
    if (one.of == number) return &one;
  return nullptr;
}

Jet Enclosure::take(const Choice& choice, const Jet& argument, const Jet& below, const Jet& above) {
  if (&choice == &_taken.back()) _argument = argument;
  return choice.above ? above : below;
}

Jet Enclosure::two_ways(Ref number, const Jet& below, const Jet& above, bool continuous,
                        double level) {
  _undecided.push_back({number, true, level});
  Jet result = hull(below, above, continuous ? 1 : 0);
  result.degree = Jet::most;
  return result;
}

Jet Enclosure::steps(Ref number, const Jet& a, bool up) {
  if (const Choice* const choice = given(number)) {
    const double level = choice->level;
    return take(*choice, a - exactly(level), exactly(up ? level : level - 1),
                exactly(up ? level + 1 : level));
  }
  const Interval& at = a.value();
  if (!at.finite() || !a.defined) return undecided(number, everything);
  const double first = up ? std::ceil(at.low) : std::floor(at.low),
               last = up ? std::ceil(at.high) : std::floor(at.high);
  if (first == last) return exactly(first);
  if (last - first > 1) return undecided(number, {first, last});
  return two_ways(number, exactly(first), exactly(last), false, up ? first : last);
}

Jet Enclosure::compare(Ref number, const Operation& operation) {
  const Jet &a = _jets[static_cast<std::size_t>(operation.of[0])],
            &b = _jets[static_cast<std::size_t>(operation.of[1])];
  const Interval &u = a.value(), &v = b.value();
  const bool equality = operation.code == Code::equal || operation.code == Code::unequal;
  const double yes = operation.code == Code::unequal ? 0 : 1, no = 1 - yes;
  const Jet difference = a - b;
  if (const Choice* const choice = given(number))
    return take(*choice, difference, exactly(1), exactly(0));
  if (!difference.defined) return undecided(number, {0, 1});  // what has no value compares as false
  // If the difference slopes, both are equal on a line only, which has no area.
  const bool sloping = slopes(difference);
  if (equality) {
    if (u.high < v.low || v.high < u.low || sloping) return exactly(no);
    if (u.low == u.high && v.is(u.low)) return exactly(yes);
    return undecided(number, {0, 1});
  }
  const bool strict = operation.code == Code::less;
  if (u.high < v.low || (u.high == v.low && (!strict || sloping))) return exactly(1);
  if (v.high < u.low || (v.high == u.low && (strict || sloping))) return exactly(0);
  return two_ways(number, exactly(1), exactly(0), false);
}

Jet Enclosure::quadrant(Ref number, const Jet& y, const Jet& x) {
  constexpr double pi = std::numbers::pi;
  const Interval half = outward(pi / 2, pi / 2), whole = outward(pi, pi);
  const auto turned = [&](const Jet& over, const Jet& under, const Interval& by) {
    return constant_jet(by) +
           elementary(Code::arc_tangent, over * power(under, exactly(-1), _order), _order);
  };
  if (const Choice* const choice = given(number))
    return take(*choice, y, turned(y, x, -whole), turned(y, x, whole));
  if (x.value().low > 0) return turned(y, x, {});
  if (y.value().low > 0) return -turned(x, y, -half);
  if (y.value().high < 0) return -turned(x, y, half);
  if (x.value().high < 0 && slopes(y)) {  // y is 0, perhaps -0, at most on a set without area
    if (y.value().low >= 0) return turned(y, x, whole);
    if (y.value().high <= 0) return turned(y, x, -whole);
  }
  if (x.value().high < 0) return two_ways(number, turned(y, x, -whole), turned(y, x, whole), false);
  return undecided(number, {-whole.high, whole.high});
}

Jet Enclosure::apply(Ref number, const Operation& operation) {
  const auto of = [&](std::size_t i) -> const Jet& {
    return _jets[static_cast<std::size_t>(operation.of[i])];
  };
  const Choice* const choice = given(number);
  switch (operation.code) {
    case Code::constant: {
      if (std::isfinite(operation.value)) return exactly(operation.value);
      Jet none = constant_jet(everything);
      none.defined = false;
      return none;
    }
    case Code::x:
    case Code::y: {
      Jet result = constant_jet(operation.code == Code::x ? _x : _y);
      result.order = _order;
      result.degree = 1;
      result.of[operation.code == Code::x ? 1 : 2] = {1, 1};
      return result;
    }
    case Code::add:
      return of(0) + of(1);
    case Code::subtract:
      return of(0) - of(1);
    case Code::multiply:
      return operation.of[0] == operation.of[1] ? square(of(0)) : of(0) * of(1);
    case Code::divide:
      return of(0) * power(of(1), exactly(-1), _order);
    case Code::negate:
      return -of(0);
    case Code::power:
      return power(of(0), of(1), _order);
    case Code::absolute: {
      const Jet& a = of(0);
      if (choice != nullptr) return take(*choice, a, -a, a);
      if (a.value().low >= 0) return a;
      if (a.value().high <= 0) return -a;
      Jet result = two_ways(number, -a, a, true);
      result.of[0] = {0, a.value().magnitude()};
      return result;
    }
    case Code::minimum:
    case Code::maximum: {
      const bool least = operation.code == Code::minimum;
      const Jet &a = of(0), &b = of(1), &below = least ? a : b, &above = least ? b : a;
      if (choice != nullptr) return take(*choice, a - b, below, above);
      const Interval &u = a.value(), &v = b.value();
      if (!a.defined || !b.defined) return undecided(number, hull(u, v));
      if (u.high <= v.low) return below;
      if (v.high <= u.low) return above;
      Jet result = two_ways(number, below, above, true);
      result.of[0] = least ? Interval{std::min(u.low, v.low), std::min(u.high, v.high)}
                           : Interval{std::max(u.low, v.low), std::max(u.high, v.high)};
      return result;
    }
    case Code::nearest:
      return steps(number, of(0) + exactly(0.5), false);
    case Code::lower:
      return steps(number, of(0), false);
    case Code::upper:
      return steps(number, of(0), true);
    case Code::sign: {
      const Jet& a = of(0);
      if (choice != nullptr) return take(*choice, a, exactly(-1), exactly(1));
      if (!a.defined) return undecided(number, {-1, 1});
      if (a.value().is(0)) return exactly(0);
      if (a.value().low > 0 || (a.value().low == 0 && slopes(a))) return exactly(1);
      if (a.value().high < 0 || (a.value().high == 0 && slopes(a))) return exactly(-1);
      if (!slopes(a)) return undecided(number, {-1, 1});
      return two_ways(number, exactly(-1), exactly(1), false);
    }
    case Code::less:
    case Code::less_equal:
    case Code::equal:
    case Code::unequal:
      return compare(number, operation);
    case Code::both:
    case Code::either: {
      const Truth a = truth(of(0)), b = truth(of(1));
      const Truth deciding = operation.code == Code::both ? Truth::no : Truth::yes;
      if (a == deciding || b == deciding) return exactly(deciding == Truth::yes ? 1 : 0);
      if (a != Truth::unknown && b != Truth::unknown)
        return exactly(deciding == Truth::yes ? 0 : 1);
      Jet result = constant_jet({0, 1});
      result.order = 0;
      result.degree = Jet::most;
      return result;
    }
    case Code::select: {
      const Truth condition = truth(of(0));
      if (condition != Truth::unknown) return condition == Truth::yes ? of(1) : of(2);
      Jet result = hull(of(1), of(2), 0);
      result.degree = Jet::most;
      return result;
    }
    case Code::arc_tangent2:
      return quadrant(number, of(0), of(1));
    default:
      return elementary(operation.code, of(0), _order);
  }
}

}  // namespace anticrack::expression
