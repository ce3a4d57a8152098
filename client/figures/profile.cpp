// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/profile.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace anticrack::figures {
namespace {

using results::Kind;

/// Runs of consecutive items of one key, as pairs (first, last); items of a negative key are in
/// none.
std::vector<std::pair<std::size_t, std::size_t>> runs(
    std::size_t count, const std::function<std::int32_t(std::size_t)>& key) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < count; ++i) {
    if (key(i) < 0) continue;
    if (i > 0 && key(i - 1) == key(i))
      found.back().second = i;
    else
      found.emplace_back(i, i);
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

Profile profile(const results::Result& result, std::size_t index, const results::Trace& trace) {
  const results::Interface& interface = result.interfaces.at(index);
  Profile profile;
  if (result.interfaces.size() > 1) profile.name = interface.name;
  const std::size_t k = interface.node_count();
  const double tolerance = k == 0 ? 0 : 1e-9 * interface.s.back();
  std::string axis;
  if (constant(interface.y, tolerance) && monotone(interface.x)) {
    axis = "x";
    profile.position = interface.x;
  } else if (constant(interface.x, tolerance) && monotone(interface.y)) {
    axis = "y";
    profile.position = interface.y;
  } else {
    axis = "arc length s";
    if (k > 0) axis += " from " + point_text(interface.x[0], interface.y[0], interface.s.back(), 4);
    profile.position = interface.s;
  }
  Range along = empty_range();
  for (const double position : profile.position) along.include(position);
  profile.labels = Scale(along);
  profile.axis = profile.labels.label(axis, result.units.label("L"));

  const auto band = [&](double a, double b) { return Band{std::min(a, b), std::max(a, b)}; };
  const auto& at = profile.position;
  const std::size_t edges = k == 0 ? 0 : k - 1;
  const auto edges_of = [&](Kind kind) {
    std::vector<Band> bands;
    for (const auto& [first, last] :
         runs(edges, [&](std::size_t e) { return interface.edges.kind[e] == kind ? 0 : -1; }))
      bands.push_back(band(at[first], at[last + 1]));
    return bands;
  };
  const std::vector<std::int32_t>& inclusion = interface.edges.inclusion;
  for (const auto& [first, last] : runs(edges, [&](std::size_t e) { return inclusion[e]; })) {
    profile.fibres.push_back({band(at[first], at[last + 1]),
                              result.mesh.inclusions[static_cast<std::size_t>(inclusion[first])]});
  }
  std::sort(profile.fibres.begin(), profile.fibres.end(),
            [](const Fibre& a, const Fibre& b) { return a.band.begin < b.band.begin; });
  profile.delaminated = edges_of(Kind::delaminated);
  profile.crack = edges_of(Kind::crack);
  profile.free = edges_of(Kind::free);
  profile.bonded = edges_of(Kind::inclusion);
  for (const auto& [first, last] :
       runs(k, [&](std::size_t i) { return trace.contact[i] != 0 ? 0 : -1; })) {
    const double begin = first == 0 ? at[0] : (at[first - 1] + at[first]) / 2;
    const double end = last + 1 == k ? at[last] : (at[last] + at[last + 1]) / 2;
    profile.contact.push_back(band(begin, end));
  }
  return profile;
}

}  // namespace anticrack::figures
