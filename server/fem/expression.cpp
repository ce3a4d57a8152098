// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>

#include "errors/errors.hpp"

namespace anticrack::fem {
namespace {

errors::Error invalid(const std::string& field, const std::string& message) {
  errors::Error error(errors::Reason::expression_invalid, message);
  error.at(field);
  return error;
}

/// muParser would take x = 1 for an assignment to the coordinate and "..." for a string.
void require_plain(const std::string& text, const std::string& field) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw invalid(field, "the expression is empty; write a number or a function of x and y");
  }
  if (std::any_of(text.begin(), text.end(), [](unsigned char c) {
        return (c < 0x20 && c != '\t' && c != '\r' && c != '\n') || c >= 0x7f;
      })) {
    throw invalid(field, "the expression holds a character that is not printable ASCII; remove it");
  }
  if (text.find('"') != std::string::npos) {
    throw invalid(field, "the expression \"" + text + "\" holds a string; only numbers, x and y");
  }
  constexpr std::string_view comparison = "=!<>";
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') {
      continue;
    }
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || comparison.find(text[i - 1]) == std::string_view::npos) {
      throw invalid(field, "the expression \"" + text + "\" assigns at position " +
                               std::to_string(i) + "; write == to compare");
    }
  }
}

/// All parsers share one locale. libstdc++ prepares it when the first number is read and looks at
/// it without a lock ever after, so the first number is read before any other thread reads one.
void prepare_locale() {
  [[maybe_unused]] static const double number = [] {
    mu::Parser parser;
    parser.SetExpr("1.5");
    return parser.Eval();
  }();
}

}  // namespace

struct ExpressionFunction::Parser {
  double x = 0;
  double y = 0;
  std::string field;
  mu::Parser parser;
};

ExpressionFunction::ExpressionFunction(const std::string& text, std::string field)
    : _parser(std::make_unique<Parser>()) {
  require_plain(text, field);
  prepare_locale();
  _parser->field = std::move(field);
  try {
    _parser->parser.DefineVar("x", &_parser->x);
    _parser->parser.DefineVar("y", &_parser->y);
    _parser->parser.SetExpr(text);
    _parser->parser.Eval();
    if (_parser->parser.GetNumResults() != 1) {
      throw invalid(_parser->field, "the expression \"" + text + "\" gives " +
                                        std::to_string(_parser->parser.GetNumResults()) +
                                        " values; it must give one");
    }
  } catch (const mu::Parser::exception_type& error) {
    throw invalid(_parser->field, "the expression \"" + text + "\" cannot be read: " +
                                      error.GetMsg() + " (symbols are x, y, _pi, _e)");
  }
}

ExpressionFunction::~ExpressionFunction() = default;
ExpressionFunction::ExpressionFunction(ExpressionFunction&&) noexcept = default;
ExpressionFunction& ExpressionFunction::operator=(ExpressionFunction&&) noexcept = default;

double ExpressionFunction::operator()(double x, double y) {
  _parser->x = x;
  _parser->y = y;
  double value = 0;
  try {
    value = _parser->parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    throw invalid(_parser->field, "the expression \"" + _parser->parser.GetExpr() +
                                      "\" cannot be evaluated: " + error.GetMsg());
  }
  if (!std::isfinite(value)) {
    std::ostringstream message;
    message.precision(17);
    message << "the expression has the value " << value << " at (x, y) = (" << x << ", " << y
            << "); it must be finite wherever the membrane is";
    throw invalid(_parser->field, message.str());
  }
  return value;
}

}  // namespace anticrack::fem
