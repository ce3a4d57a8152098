// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/function.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "errors/errors.hpp"
#include "expression/parse.hpp"

namespace anticrack::expression {

Function::Function(const std::string& text, std::string field)
    : _field(std::move(field)), _tape(parse(text, _field)) {}

double Function::operator()(double x, double y) const {
  std::array<double, kernel_width> at_x{}, at_y{};
  at_x.fill(x);
  at_y.fill(y);
  const Ref root = _tape.result();
  Evaluator evaluator(_tape, {&root, 1});
  evaluator(at_x.data(), at_y.data(), 1);
  const double value = *evaluator.values(0);
  require_finite(x, y, value);
  return value;
}

void Function::require_finite(double x, double y, double value) const {
  if (!std::isfinite(value)) {
    throw errors::Error(
        errors::Reason::expression_invalid,
        "the expression has the value {} at (x, y) = {}; it must be finite wherever "
        "the membrane is",
        value, errors::shown(x, y))
        .at(_field);
  }
}

}  // namespace anticrack::expression
