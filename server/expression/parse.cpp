// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/parse.hpp"

#include <fmt/core.h>
#include <muParser.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "errors/errors.hpp"

namespace anticrack::expression {
namespace {

errors::Error invalid(const std::string& field, const std::string& message) {
  errors::Error error(errors::Reason::expression_invalid, message);
  error.at(field);
  return error;
}

/// muParser would take x = 1 for an assignment to the coordinate and "..." for a string.
void require_plain(const std::string& text, const std::string& field) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw invalid(field, "the expression is empty; write a number or a function of x and y");
  if (std::any_of(text.begin(), text.end(), [](unsigned char c) {
        return (c < 0x20 && c != '\t' && c != '\r' && c != '\n') || c >= 0x7f;
      }))
    throw invalid(field, "the expression holds a character that is not printable ASCII; remove it");
  if (text.find('"') != std::string::npos)
    throw invalid(field, "the expression \"" + text + "\" holds a string; only numbers, x and y");
  constexpr std::string_view comparison = "=!<>";
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || comparison.find(text[i - 1]) == std::string_view::npos) {
      throw invalid(field,
                    fmt::format("the expression \"{}\" assigns at position {}; write == to compare",
                                text, i));
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

/// The number of a text like "3 N/mm"; none for "3 x", where an operator was forgotten.
std::optional<std::string> number_with_unit(const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const char* const first = std::find_if(text.data(), end, [](char c) { return c > ' '; });
  const char* const rest = std::from_chars(first, end, value).ptr;
  const auto letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  const char* const unit = std::find_if(rest, end, [](char c) { return c > ' '; });
  const char* const behind = std::find_if_not(unit, end, letter);
  const std::string_view word(unit, static_cast<std::size_t>(behind - unit));
  const bool named = rest != first && !word.empty() && word != "x" && word != "y";
  if (!named || std::find(behind, end, '(') != end) return std::nullopt;
  return std::string(first, rest);
}

/// Lets muParser check whether a text is an expression, and explain what is wrong if it is not.
void require_syntax(const std::string& text, const std::string& field) {
  require_plain(text, field);
  prepare_locale();
  double x = 0, y = 0;
  mu::Parser parser;
  try {
    parser.DefineFun("floor", static_cast<double (*)(double)>(std::floor));
    parser.DefineFun("ceil", static_cast<double (*)(double)>(std::ceil));
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.SetExpr(text);
    parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    if (const auto number = number_with_unit(text)) {
      throw invalid(field, "\"" + text + "\" is a number with a unit; write " + *number +
                               ": the units of all numbers are those of [units]");
    }
    if (text.find("**") != std::string::npos) {
      throw invalid(field,
                    "the expression \"" + text + "\" has **; a power is ^, so write x^2 for x**2");
    }
    throw invalid(field, "the expression \"" + text + "\" cannot be read: " + error.GetMsg() +
                             " (symbols are x, y, _pi, _e)");
  }
  if (parser.GetNumResults() != 1) {
    throw invalid(field, fmt::format("the expression \"{}\" gives {} values; it must give one, and "
                                     "the decimal sign is a point",
                                     text, parser.GetNumResults()));
  }
}

enum class Role { open, unary, binary, question, colon };

/// An operation that waits on the stack for its right operand.
struct Pending {
  Role role;
  int precedence;
  Code code = Code::count;
  bool swapped = false;            ///< a > b is b < a
  std::string_view function = {};  ///< of an opening parenthesis
  std::size_t arguments = 0;       ///< read so far
};

struct Operator {
  std::string_view text;
  int precedence;
  Code code;
  bool swapped = false;
};

constexpr int precedence_of_sign = 6, precedence_of_power = 7;
constexpr Operator operators[] = {{"&&", 2, Code::both},
                                  {"||", 1, Code::either},
                                  {"<=", 4, Code::less_equal},
                                  {">=", 4, Code::less_equal, true},
                                  {"==", 4, Code::equal},
                                  {"!=", 4, Code::unequal},
                                  {"<", 4, Code::less},
                                  {">", 4, Code::less, true},
                                  {"+", 5, Code::add},
                                  {"-", 5, Code::subtract},
                                  {"*", 6, Code::multiply},
                                  {"/", 6, Code::divide},
                                  {"^", precedence_of_power, Code::power}};

#define ANTICRACK_FUNCTION(code, name, cost, value) {name, Code::code},
constexpr std::pair<std::string_view, Code> functions[] = {
    {"ln", Code::logarithm}, {"avg", Code::add}, ANTICRACK_OPERATIONS(ANTICRACK_FUNCTION)};
#undef ANTICRACK_FUNCTION

/// Reads a text that muParser accepts, with the stacks of its shunting yard: nothing recurses,
/// however deep the text is nested.
class Reader {
 public:
  explicit Reader(std::string_view text) : _text(text) {}

  Tape read() {
    bool operand_next = true;
    for (skip_blanks(); _at < _text.size(); skip_blanks())
      operand_next = operand_next ? read_operand() : read_operator();
    reduce_all();
    _tape.finish(pop());
    return std::move(_tape);
  }

 private:
  [[noreturn]] void fail() const {
    throw errors::Error(errors::Reason::internal,
                        "the expression \"{}\" is read in two ways at position {}", _text, _at);
  }

  void skip_blanks() {
    while (_at < _text.size() && _text[_at] <= ' ') ++_at;
  }

  bool take(std::string_view token) {
    if (_text.substr(_at, token.size()) != token) return false;
    _at += token.size();
    return true;
  }

  Ref pop() {
    if (_values.empty()) fail();
    const Ref value = _values.back();
    _values.pop_back();
    return value;
  }

  /// Reads an operand; true if another operand must follow.
  bool read_operand() {
    const char c = _text[_at];
    if (c == '(') {
      ++_at;
      _pending.push_back({Role::open, 0});
      return true;
    }
    if (c == '+' || c == '-') {
      ++_at;
      if (c == '-') _pending.push_back({Role::unary, precedence_of_sign, Code::negate});
      return true;
    }
    if (c == '.' || (c >= '0' && c <= '9')) {
      double value = 0;
      const auto [end, error] =
          std::from_chars(_text.data() + _at, _text.data() + _text.size(), value);
      if (error == std::errc::invalid_argument) fail();
      if (error == std::errc::result_out_of_range) value = 0;  // muParser refuses large ones
      _at = static_cast<std::size_t>(end - _text.data());
      _values.push_back(_tape.constant(value));
      return false;
    }
    return read_name();
  }

  bool read_name() {
    std::size_t end = _at;
    while (end < _text.size() &&
           (_text[end] == '_' || std::isalnum(static_cast<unsigned char>(_text[end])) != 0))
      ++end;
    const std::string_view name = _text.substr(_at, end - _at);
    _at = end;
    if (take("(")) {
      _pending.push_back({Role::open, 0, Code::count, false, name});
      return true;
    }
    if (name == "x")
      _values.push_back(_tape.x());
    else if (name == "y")
      _values.push_back(_tape.y());
    else if (name == "_pi" || name == "_e")
      _values.push_back(_tape.constant(name == "_pi" ? std::numbers::pi : std::numbers::e));
    else
      fail();
    return false;
  }

  bool read_operator() {
    if (take(")")) {
      reduce_all();
      close();
      return false;
    }
    if (take(",")) {
      reduce_all();
      if (_pending.empty()) fail();
      ++_pending.back().arguments;
      return true;
    }
    if (take("?")) {
      reduce(0);
      _pending.push_back({Role::question, 0});
      return true;
    }
    if (take(":")) {
      while (!_pending.empty() && _pending.back().role != Role::question) reduce_one();
      if (_pending.empty()) fail();
      _pending.back().role = Role::colon;
      return true;
    }
    for (const Operator& one : operators) {
      if (take(one.text)) {
        // A power takes its right operand first.
        reduce(one.precedence + (one.code == Code::power ? 1 : 0));
        _pending.push_back({Role::binary, one.precedence, one.code, one.swapped});
        return true;
      }
    }
    fail();
  }

  /// Applies waiting operations that bind at least as strongly.
  void reduce(int precedence) {
    while (!_pending.empty() &&
           (_pending.back().role == Role::unary || _pending.back().role == Role::binary) &&
           _pending.back().precedence >= precedence)
      reduce_one();
  }

  void reduce_all() {
    while (!_pending.empty() && _pending.back().role != Role::open) reduce_one();
  }

  void reduce_one() {
    const Pending top = _pending.back();
    _pending.pop_back();
    const Ref right = pop();
    if (top.role == Role::unary) {
      _values.push_back(_tape.apply(top.code, right));
      return;
    }
    const Ref left = pop();
    if (top.role == Role::colon) {
      _values.push_back(_tape.apply(Code::select, pop(), left, right));
    } else if (top.role == Role::binary) {
      _values.push_back(top.swapped ? _tape.apply(top.code, right, left)
                                    : _tape.apply(top.code, left, right));
    } else {
      fail();
    }
  }

  void close() {
    if (_pending.empty()) fail();
    const Pending open = _pending.back();
    _pending.pop_back();
    if (open.function.empty()) return;
    const auto* found = std::find_if(std::begin(functions), std::end(functions),
                                     [&](const auto& one) { return one.first == open.function; });
    if (found == std::end(functions)) fail();
    const std::size_t count = open.arguments + 1;
    if (_values.size() < count) fail();
    const auto first = _values.end() - static_cast<std::ptrdiff_t>(count);
    const bool list = found->second == Code::minimum || found->second == Code::maximum ||
                      found->second == Code::add;
    Ref value = *first;
    if (list) {
      for (auto next = first + 1; next != _values.end(); ++next)
        value = _tape.apply(found->second, value, *next);
      if (open.function == "avg")
        value = _tape.apply(Code::divide, value, _tape.constant(static_cast<double>(count)));
    } else {
      value = _tape.apply(found->second, value, count > 1 ? first[1] : -1);
    }
    _values.erase(first, _values.end());
    _values.push_back(value);
  }

  std::string_view _text;
  std::size_t _at = 0;
  Tape _tape;
  std::vector<Ref> _values;
  std::vector<Pending> _pending;
};

}  // namespace

Tape parse(const std::string& text, const std::string& field) {
  require_syntax(text, field);
  return Reader(text).read();
}

}  // namespace anticrack::expression
