// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

namespace anticrack::fem {

/// A scalar function of x and y given as text, in muParser's syntax with its functions and the
/// constants _pi and _e. Assignments, strings and lists of results are refused: a load is one
/// number per point. One object belongs to one thread; make another for another thread.
class ExpressionFunction {
 public:
  /// `field` is named in errors, e.g. "force.expression". Throws errors::Error
  /// (expression_invalid) on a syntax error or an unknown symbol.
  ExpressionFunction(const std::string& text, std::string field);
  ~ExpressionFunction();
  ExpressionFunction(ExpressionFunction&&) noexcept;
  ExpressionFunction& operator=(ExpressionFunction&&) noexcept;

  /// Throws errors::Error (expression_invalid) naming the point when the value is not finite.
  double operator()(double x, double y);

 private:
  struct Parser;
  std::unique_ptr<Parser> _parser;
};

}  // namespace anticrack::fem
