// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/profile.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace anticrack::figures {
namespace {

using results::Interface;
using results::Kind;

/// Condition on edge e. Kinds belong to nodes, and a tip has that of its tied neighbour: an edge
/// is a crack when one of its ends is, else bonded only when both are.
Kind edge_kind(const Interface& interface, std::size_t e) {
  const Kind a = interface.kind[e];
  const Kind b = interface.kind[e + 1];
  for (const Kind open : {Kind::delaminated, Kind::crack}) {
    if (a == open || b == open) return open;
  }
  return a == Kind::inclusion && b == Kind::inclusion ? Kind::inclusion : Kind::glue;
}

/// Runs of consecutive items that satisfy `holds`, as pairs (first, last).
std::vector<std::pair<std::size_t, std::size_t>> runs(
    std::size_t count, const std::function<bool(std::size_t)>& holds) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < count; ++i) {
    if (!holds(i)) continue;
    if (i > 0 && !found.empty() && found.back().second + 1 == i) {
      found.back().second = i;
    } else {
      found.emplace_back(i, i);
    }
  }
  return found;
}

bool constant(const std::vector<double>& values, double tolerance) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return values.empty() || *high - *low <= tolerance;
}

bool monotone(const std::vector<double>& values) {
  return std::is_sorted(values.begin(), values.end()) ||
         std::is_sorted(values.begin(), values.end(), std::greater<>());
}

}  // namespace

Profile profile(const Interface& interface, const results::Trace& trace) {
  Profile profile;
  const std::size_t k = interface.node_count();
  const double tolerance = k == 0 ? 0 : 1e-9 * interface.s.back();
  if (constant(interface.y, tolerance) && monotone(interface.x)) {
    profile.axis = "x [-]";
    profile.position = interface.x;
  } else if (constant(interface.x, tolerance) && monotone(interface.y)) {
    profile.axis = "y [-]";
    profile.position = interface.y;
  } else {
    profile.axis = "arc length s [-]";
    profile.position = interface.s;
  }

  const auto band = [&](double a, double b) { return Band{std::min(a, b), std::max(a, b)}; };
  const auto& at = profile.position;
  const std::size_t edges = k == 0 ? 0 : k - 1;
  const auto edges_of = [&](Kind kind) {
    std::vector<Band> bands;
    for (const auto& [first, last] :
         runs(edges, [&](std::size_t e) { return edge_kind(interface, e) == kind; })) {
      bands.push_back(band(at[first], at[last + 1]));
    }
    return bands;
  };
  for (const auto& [first, last] : runs(edges, [&](std::size_t e) {
         const Kind kind = edge_kind(interface, e);
         return kind == Kind::inclusion || kind == Kind::delaminated;
       })) {
    profile.fibres.push_back({band(at[first], at[last + 1]), (first + last + 1) / 2});
  }
  profile.delaminated = edges_of(Kind::delaminated);
  profile.crack = edges_of(Kind::crack);
  profile.bonded = edges_of(Kind::inclusion);
  for (const auto& [first, last] : runs(k, [&](std::size_t i) { return trace.contact[i] != 0; })) {
    const double begin = first == 0 ? at[0] : (at[first - 1] + at[first]) / 2;
    const double end = last + 1 == k ? at[last] : (at[last] + at[last + 1]) / 2;
    profile.contact.push_back(band(begin, end));
  }
  return profile;
}

}  // namespace anticrack::figures
