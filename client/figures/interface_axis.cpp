// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/interface_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

struct Mark {
  const std::vector<Band>& bands;
  const char* name;
  const std::string& colour;
};

std::array<Mark, 4> marks_of(const Profile& profile) {
  return {{{profile.delaminated, "delaminated inclusion", delaminated_colour},
           {profile.bonded, "bonded inclusion", bonded_colour},
           {profile.crack, "crack", crack_colour},
           {profile.free, "free crack", free_colour}}};
}

/// Strips from the foot of the graph to the height `top`, one command a band.
std::string strips(const std::vector<Band>& bands, const std::string& top, const std::string& layer,
                   const std::string& colour) {
  std::string text;
  for (const Band& band : bands) {
    text += "set object rectangle from first " + number(band.begin, 12) + ", graph 0 to first " +
            number(band.end, 12) + ", graph " + top + " " + layer + " fillcolor " + colour +
            " fillstyle solid 1 noborder\n";
  }
  return text;
}

std::string names(const Profile& profile) {
  constexpr std::size_t longest = 24;
  constexpr double character = 0.022;  // width, part of the axis
  const Range along = extent(profile);
  std::string text;
  int tag = 20;  // beyond those of the axes
  double free_from = 0;
  for (const auto& [band, inclusion] : profile.fibres) {
    const double half = 0.5 * character * static_cast<double>(std::min(length(inclusion), longest));
    const double middle = (0.5 * (band.begin + band.end) - along.low) / along.size();
    const double at = std::clamp(middle, std::min(half, 0.5), std::max(1 - half, 0.5));
    if (at - half < free_from) continue;
    free_from = at + half + character;
    text += "set label " + std::to_string(tag++) + " " + figures::quoted(inclusion, longest) +
            " at graph " + number(at) + ", graph 0.075 center noenhanced font ',7' textcolor " +
            black + " front\n";
  }
  return text;
}

}  // namespace

Range extent(const Profile& profile) {
  Range along = empty_range();
  for (const double position : profile.position) along.include(position);
  return along;
}

std::string contact_strips(const Profile& profile) {
  return strips(profile.contact, "1", "behind", contact_shade);
}

std::string part_bars(const Profile& profile) {
  std::string text;
  for (const Mark& mark : marks_of(profile))
    text += strips(mark.bands, "0.03", "front", mark.colour);
  return text + names(profile);
}

Keys part_keys(const Profile& profile) {
  Keys keys;
  const auto add = [&](const std::vector<Band>& bands, const char* name,
                       const std::string& colour) {
    if (bands.empty()) return;
    keys.plots += ", keyentry with boxes fillstyle solid 1 noborder linecolor " + colour +
                  " title '" + name + "'";
    ++keys.count;
  };
  add(profile.contact, "contact", contact_shade);
  for (const Mark& mark : marks_of(profile)) add(mark.bands, mark.name, mark.colour);
  return keys;
}

Range with_bars(Range range, const Profile& profile) {
  const double size = range.size();
  return {range.low - (profile.fibres.empty() ? 0.08 : 0.2) * size, range.high + 0.06 * size};
}

bool can_open(const results::Interface& interface) {
  return std::ranges::any_of(interface.edges.kind, [](results::Kind kind) {
    return kind != results::Kind::glue && kind != results::Kind::inclusion;
  });
}

Eventful most_eventful(const results::Result& result, const std::vector<results::Load>& loads) {
  constexpr double rounding = 1e-9;  // of u
  std::vector<double> jumps(result.interfaces.size(), 0), contact(result.interfaces.size(), 0);
  double largest = 0;
  for (const results::Load& load : loads) {
    for (std::size_t i = 0; i < load.traces.size(); ++i) {
      Range u{0, 0}, jump{0, 0};
      for (const double value : load.traces[i].u_plus) u.include(value);
      for (const double value : load.traces[i].jump) jump.include(value);
      largest = std::max({largest, -u.low, u.high});
      jumps[i] = std::max({jumps[i], -jump.low, jump.high});
      double length = 0;
      for (const Band& band : profile(result, i, load.traces[i]).contact)
        length += band.end - band.begin;
      contact[i] = std::max(contact[i], length);
    }
  }
  if (jumps.empty()) return {};
  const auto index_of_largest = [](const std::vector<double>& values) {
    return static_cast<std::size_t>(std::ranges::max_element(values) - values.begin());
  };
  const std::size_t longest = index_of_largest(contact);
  std::size_t open = index_of_largest(jumps);
  if (jumps[open] <= rounding * largest) open = longest;
  return {open, 2 * contact[open] >= contact[longest] ? open : longest};
}

}  // namespace anticrack::figures
