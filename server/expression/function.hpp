// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "expression/evaluator.hpp"
#include "expression/tape.hpp"

namespace anticrack::expression {

/// A scalar function of x and y given as text (parse.hpp). Never changes.
class Function {
 public:
  /// `field` is named in errors, e.g. "force.expression". Throws as parse().
  Function(const std::string& text, std::string field);

  const Tape& tape() const noexcept { return _tape; }

  /// The value at one point; use Evaluator for many. Throws as require_finite().
  double operator()(double x, double y) const;

  /// Throws errors::Error (expression_invalid) naming the point when the value is not finite.
  void require_finite(double x, double y, double value) const;

 private:
  std::string _field;
  Tape _tape;
};

}  // namespace anticrack::expression
