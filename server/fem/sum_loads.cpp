// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <utility>

#include "fem/load.hpp"

namespace anticrack::fem {
namespace {

/// dead + t live as text; empty texts are 0.
std::string sum_of(const std::string& dead, double t, const std::string& live) {
  if (live.empty()) return dead;
  const std::string scaled = fmt::format("({:.17g})*({})", t, live);
  return dead.empty() ? scaled : fmt::format("({}) + {}", dead, scaled);
}

/// As an expression, if it is one.
std::string text_of(const Force& force) {
  if (const auto* constant = std::get_if<double>(&force)) return fmt::format("{:.17g}", *constant);
  return std::get<Expression>(force).text;
}

bool per_region(const Force& force) { return std::holds_alternative<PerRegion>(force); }

/// On a subdomain, of a constant or values per region.
double on(const std::string& subdomain, const Force& force) {
  if (const auto* constant = std::get_if<double>(&force)) return *constant;
  const auto& values = std::get<PerRegion>(force).values;
  const auto found = values.find(subdomain);
  return found == values.end() ? 0 : found->second;
}

}  // namespace

std::string obstacle_to_sum(const Force& dead, const Force& live) {
  for (const Force* force : {&dead, &live})
    if (std::holds_alternative<Array>(*force)) return "one of them is an array";
  for (const auto& [one, other] : {std::pair(&dead, &live), {&live, &dead}})
    if (per_region(*one) && std::holds_alternative<Expression>(*other))
      return "one has values per region and the other is an expression";
  return {};
}

Load sum(const Load& dead, double t, const Load& live, const std::vector<std::string>& subdomains) {
  Load both = dead;
  both.name = live.name;
  if (per_region(dead.force) || per_region(live.force)) {
    PerRegion& regions = both.force.emplace<PerRegion>();
    for (const std::string& name : subdomains)
      regions.values[name] = on(name, dead.force) + t * on(name, live.force);
  } else {
    both.force = Expression{sum_of(text_of(dead.force), t, text_of(live.force))};
  }
  both.boundary_value = sum_of(dead.boundary_value, t, live.boundary_value);
  both.traction = sum_of(dead.traction, t, live.traction);
  for (PointForce force : live.point_forces) {
    force.value *= t;
    both.point_forces.push_back(force);
  }
  for (const auto& [name, force] : live.inclusion_forces) both.inclusion_forces[name] += t * force;
  for (const auto& [name, moment] : live.inclusion_moments) {
    both.inclusion_moments[name].x += t * moment.x;
    both.inclusion_moments[name].y += t * moment.y;
  }
  return both;
}

}  // namespace anticrack::fem
