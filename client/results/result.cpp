// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/result.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "results/entries.hpp"

namespace anticrack::results {
namespace {

/// Whether a load may have this name, which becomes the name of a group in the file.
bool is_load_name(std::string_view name) noexcept {
  constexpr std::string_view all =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_. -";
  return !name.empty() && name.size() <= 64 && name.find_first_not_of(all) == name.npos &&
         name.find_first_not_of("_. -") == 0;
}

}  // namespace

std::string load_path(const std::string& name) { return "loads/" + name + "/"; }

std::string status_name(int status) {
  return name_in(*v1::LoadCaseAnswer::Status_descriptor(), status);
}

double largest_kkt(const v1::LoadCaseAnswer& answer) noexcept {
  if (!answer.has_kkt()) return unknown;
  const v1::KktResiduals& kkt = answer.kkt();
  double result = 0;
  for (const double residual : {kkt.equilibrium_relative(), kkt.gap_relative(), kkt.sign_relative(),
                                kkt.complementarity_relative()}) {
    if (std::isnan(residual)) return residual;
    result = std::max(result, residual);
  }
  return result;
}

double solve_seconds(const Result& result) {
  if (result.sweep) return number_in(result.sweep->answer, "solve_seconds");
  double seconds = 0;
  for (const Load& load : result.loads) seconds += number_in(load.answer, "solve_seconds");
  return seconds;
}

std::string unit_of(const v1::Units& units, std::string_view dimension) {
  std::string unit;
  for (const char c : dimension) {
    const bool is_unit = c == 'F' || c == 'L';
    const std::string& name = c == 'F' ? units.force() : units.length();
    if (is_unit && name.empty()) return "-";
    if (is_unit)
      unit += name;
    else
      unit += c;
  }
  return unit.empty() ? "-" : unit;
}

std::string unit_behind(const v1::Units& units, std::string_view dimension) {
  const std::string unit = unit_of(units, dimension);
  return unit == "-" ? "" : " " + unit;
}

std::string labelled(const std::string& name, const v1::Units& units, std::string_view dimension) {
  const std::string unit = unit_of(units, dimension);
  return unit == "-" ? name : name + " [" + unit + "]";
}

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

std::string first_fault(const Result& result) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < result.loads.size(); ++i) {
    const Load& load = result.loads[i];
    const std::string at = fmt::format("loads[{}]", i);
    if (!is_load_name(load.name()))
      return at + ".name is not of the form [A-Za-z0-9][A-Za-z0-9_. -]{0,63}";
    if (!names.insert(load.name()).second)
      return at + ".name \"" + load.name() + "\" is there twice";
    if (!v1::LoadCaseAnswer::Status_IsValid(load.answer.status())) return at + ".status is unknown";
    for (const v1::Stage& stage : load.stages)
      if (stage.answers_size() != 1) return at + ".stages has one without an answer";
  }
  if (!result.sweep) return {};
  const std::size_t kept = result.sweep->integers("kept").size();
  if (std::string fault = first_fault(*result.sweep); !fault.empty()) return fault;
  return result.loads.size() == kept
             ? ""
             : fmt::format("loads has {} entries for {} kept rows", result.loads.size(), kept);
}

}  // namespace anticrack::results
