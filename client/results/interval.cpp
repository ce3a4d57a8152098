// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/interval.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace anticrack::results {

std::string interval(double value, double lower, double upper) {
  if (!std::isfinite(lower) || !std::isfinite(upper)) return "-";
  const double half = 0.5 * (upper - lower), size = std::max(std::abs(value), half);
  if (!(size > 0)) return "0 +- 0";
  const auto decade = [](double number) {
    return static_cast<int>(std::floor(std::log10(number)));
  };
  constexpr int most_digits = 6;  // after the first digit of the larger number
  const int exponent = decade(size) < -4 || decade(size) > 5 ? decade(size) : 0;
  const int behind =
      std::min(most_digits - decade(size), half > 0 ? 1 - decade(half) : most_digits);
  const double unit = std::pow(10.0, -behind);
  const double shown = std::round(value / unit) * unit;
  const double beside = std::ceil(std::max(upper - shown, shown - lower) / unit - 1e-6) * unit;
  const int decimals = std::max(0, behind + exponent);
  const double scale = std::pow(10.0, -exponent);
  const auto fixed = [&](double number) {
    return fmt::format("{:.{}f}", number * scale + 0.0, decimals);
  };
  const std::string text = fixed(shown) + " +- " + fixed(beside);
  return exponent == 0 ? text : fmt::format("({})e{}", text, exponent);
}

}  // namespace anticrack::results
