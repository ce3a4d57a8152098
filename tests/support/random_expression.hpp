// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <string>

namespace anticrack::testing {

/// Texts of expressions in x and y: the same seed, the same texts.
class RandomExpression {
 public:
  explicit RandomExpression(unsigned seed) : _random(seed) {}

  /// Anything the grammar has, nested so deep.
  std::string any(int depth) {
    if (depth == 0 || pick(8) == 0) return leaf();
    switch (pick(8)) {
      case 0:
      case 1:
        return function() + "(" + any(depth - 1) + ")";
      case 2:
        return "(" + condition(depth - 1) + " ? " + any(depth - 1) + " : " + any(depth - 1) + ")";
      case 3:
        return list() + "(" + any(depth - 1) + ", " + any(depth - 1) +
               (pick(2) == 0 ? ", " + any(depth - 1) : "") + ")";
      case 4:
        return "atan2(" + any(depth - 1) + ", " + any(depth - 1) + ")";
      case 5:
        return "(-" + any(depth - 1) + "^" + std::to_string(1 + pick(5)) + ")";
      default:
        return "(" + any(depth - 1) + binary() + any(depth - 1) + ")";
    }
  }

  /// A text with something added to it.
  std::string joined(const std::string& base) {
    switch (pick(5)) {
      case 0:
        return function() + "(" + base + ")";
      case 1:
        return "(" + base + binary() + any(2) + ")";
      case 2:
        return "(" + condition(1) + " ? " + base + " : " + any(1) + ")";
      case 3:
        return "rint(" + std::to_string(1 + pick(1000)) + "*(" + base + "))";
      default:
        return "sin(" + std::to_string(1 + pick(1000)) + "*(" + base + "))";
    }
  }

  /// Bounded, smooth, of about the size of 1; varies over about 1 / waves.
  std::string smooth(int waves) {
    const std::string a = number(waves), b = number(waves), c = number(1);
    switch (pick(5)) {
      case 0:
        return "sin(" + a + "*x + " + b + "*y + " + c + ")";
      case 1:
        return "exp(-(" + a + "*x + " + c + ")^2 - (" + b + "*y)^2)";
      case 2:
        return "1/(1 + (" + a + "*x + " + c + ")^2 + y^2)";
      case 3:
        return "(" + c + " + x*y - x^2)";
      default:
        return "cos(" + a + "*x)*cos(" + b + "*y)";
    }
  }

  /// True on one side of a line or of a curve.
  std::string side() {
    const std::string a = number(1), b = number(1), c = number(0.5);
    switch (pick(4)) {
      case 0:
        return "(x - " + c + ")^2 + (y - " + a + "/2)^2 < " + std::to_string(0.05 + 0.1 * pick(4));
      case 1:
        return "sin(" + number(4) + "*x) > y + " + c;
      case 2:
        return a + "*x*y < " + c + "/2 + x";
      default:
        return a + "*x + " + b + "*y > " + c;
    }
  }

  int pick(int choices) { return static_cast<int>(_random() % static_cast<unsigned>(choices)); }
  /// In (-size, size), in parentheses where it is negative.
  std::string number(double size) {
    const double value = size * (static_cast<double>(pick(2001)) - 1000) / 1000;
    return (value < 0 ? "(" : "") + std::to_string(value) + (value < 0 ? ")" : "");
  }

 private:
  std::string leaf() {
    switch (pick(6)) {
      case 0:
      case 1:
        return "x";
      case 2:
      case 3:
        return "y";
      case 4:
        return pick(2) == 0 ? "_pi" : "_e";
      default:
        return std::to_string(pick(30)) + (pick(2) == 0 ? ".25" : "");
    }
  }
  std::string condition(int depth) {
    static constexpr const char* compare[] = {"<", ">", "<=", ">=", "==", "!="};
    const std::string one = any(depth) + " " + compare[pick(6)] + " " + any(depth);
    return pick(3) != 0 ? one : one + (pick(2) == 0 ? " && " : " || ") + any(1) + " < " + any(1);
  }
  std::string function() {
    static constexpr const char* names[] = {"sin",   "cos",  "tan",   "asin",  "acos", "atan",
                                            "sinh",  "cosh", "tanh",  "asinh", "exp",  "log",
                                            "log2",  "ln",   "log10", "sqrt",  "abs",  "rint",
                                            "floor", "ceil", "sign",  "acosh", "atanh"};
    return names[pick(23)];
  }
  std::string list() {
    static constexpr const char* names[] = {"min", "max", "sum", "avg"};
    return names[pick(4)];
  }
  std::string binary() {
    static constexpr const char* names[] = {"+", "-", "*", "/", "^", "*", "+"};
    return names[pick(7)];
  }

  std::mt19937 _random;
};

}  // namespace anticrack::testing
