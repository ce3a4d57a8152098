// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "figures/axes.hpp"
#include "figures/panels.hpp"
#include "figures/profile.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;

/// Strips from the height `bottom` of the graph to the height `top`, one command a band.
std::string strips(const std::vector<Band>& bands, const std::string& bottom,
                   const std::string& top, const std::string& style) {
  const std::string from_height = ", graph " + bottom + " to first ";
  const std::string to_height = ", graph " + top + " " + style + "\n";
  std::string text;
  for (const Band& band : bands) {
    text += "set object rectangle from first " + number(band.begin);
    text += from_height + number(band.end);
    text += to_height;
  }
  return text;
}

struct Mark {
  const std::vector<Band>& bands;
  std::string name;
  std::string colour;
};

/// Names above the bars of the inclusions, as long as they do not meet.
std::string names(const Profile& profile, const Range& along) {
  constexpr std::size_t longest = 24;
  constexpr double character = 0.022;  // width, part of the axis
  std::string text;
  double free_from = 0;
  for (const auto& [band, inclusion] : profile.fibres) {
    const double half = 0.5 * character * static_cast<double>(std::min(length(inclusion), longest));
    const double middle = (0.5 * (band.begin + band.end) - along.low) / along.size();
    const double at = std::clamp(middle, std::min(half, 0.5), std::max(1 - half, 0.5));
    if (at - half < free_from) continue;
    free_from = at + half + character;
    text += "set label " + quoted(inclusion, longest) + " at graph " + number(at) +
            ", graph 0.075 center noenhanced font ',7' textcolor " + black + " front\n";
  }
  return text;
}

std::string traces_heading(const Profile& profile, const Load& load) {
  constexpr std::size_t most = 50;
  const std::string where =
      profile.name.empty() ? std::string("the interface") : shortened(profile.name, 20);
  std::string answer;
  for (const results::Inclusion& inclusion : load.inclusions) {
    const bool here =
        std::any_of(profile.fibres.begin(), profile.fibres.end(),
                    [&](const Fibre& fibre) { return fibre.inclusion == inclusion.name; });
    if (!here) continue;
    answer += ",  A = " + (std::isfinite(inclusion.displacement_lower)
                               ? bounded(inclusion.displacement_lower, inclusion.displacement_upper)
                               : readable(inclusion.displacement));
    if (inclusion.tilted()) {
      answer += ", B = (" + readable(inclusion.slope_x) + ", " + readable(inclusion.slope_y) + ")";
    }
    if (load.inclusions.size() > 1) answer += " (" + shortened(inclusion.name, 12) + ")";
  }
  if (load.status == results::Status::not_converged) answer += ",  not converged";
  const std::string full = "displacements on " + where + answer;
  return length(full) <= most ? full : where + answer;
}

/// The range of u+, u-, [u] and zero. If these are rounding errors compared with u on the membrane,
/// estimated from Pi(u), the range of u, so that zero looks like zero.
Range heights(const results::Trace& trace, const Load& load) {
  Range range{0, 0};
  for (const auto* values : {&trace.u_minus, &trace.u_plus, &trace.jump})
    for (const double value : *values) range.include(value);
  const double typical = std::isfinite(load.energy) ? std::sqrt(std::abs(load.energy)) : 0;
  if (range.size() < 1e-9 * typical) {
    const double power = std::pow(10.0, std::floor(std::log10(typical)));
    range = {-power, power};
  }
  return range;
}

std::string traces_data(const Profile& profile, const results::Trace& trace) {
  std::string text = "$traces << EOD\n";
  for (std::size_t i = 0; i < profile.position.size(); ++i) {
    text += number(profile.position[i]) + " " + number(trace.u_minus[i]) + " " +
            number(trace.u_plus[i]) + " " + number(trace.jump[i]) + "\n";
  }
  return text + "EOD\n";
}

std::string traces_panel(const Profile& profile, const results::Trace& trace, const Load& load,
                         const Place& place) {
  const Mark marks[] = {{profile.delaminated, "delaminated inclusion", delaminated_colour},
                        {profile.bonded, "bonded inclusion", bonded_colour},
                        {profile.crack, "crack", crack_colour},
                        {profile.free, "free crack", free_colour}};
  std::string text = margins(place, 0.305, 0.905) + axes();
  std::string keys;
  int entries = 3;
  const auto key = [&](const std::string& name, const std::string& colour) {
    keys += ", keyentry with boxes fillstyle solid 1 noborder linecolor " + colour + " title '" +
            name + "'";
    ++entries;
  };
  text += strips(profile.contact, "0", "1",
                 "behind fillcolor " + contact_shade + " fillstyle solid 1 noborder");
  if (!profile.contact.empty()) key("contact", contact_shade);
  for (const Mark& mark : marks) {
    text += strips(mark.bands, "0", "0.03",
                   "front fillcolor " + mark.colour + " fillstyle solid 1 noborder");
    if (!mark.bands.empty()) key(mark.name, mark.colour);
  }

  Range along = empty_range();
  for (const double position : profile.position) along.include(position);
  Range high = heights(trace, load);
  const double size = high.size();
  high.low -= (profile.fibres.empty() ? 0.08 : 0.2) * size;  // room for bars and names
  high.high += 0.06 * size;
  const Scale scale(high);
  text += axis_range('x', along) + axis_range('y', scale.drawn(high), 9);
  text += caption(traces_heading(profile, load), place);
  text += below(figures::quoted(profile.axis), 0.2, place) +
          beside("'displacement " + scale.unit() + "'", place) + names(profile, along);
  text += legend((entries + 1) / 2, place);
  text += "plot 0 with lines linewidth 0.7 linecolor rgb '#888888' notitle, ";
  text += "$traces using 1:" + scale.column(2) + " with lines linewidth 1.5 linecolor " + blue +
          " dashtype solid title 'u\xE2\x81\xBB'";
  text += ", $traces using 1:" + scale.column(3) + " with lines linewidth 1.5 linecolor " +
          vermillion + " dashtype (8,4) title 'u\xE2\x81\xBA'";
  text += ", $traces using 1:" + scale.column(4) + " with lines linewidth 1.5 linecolor " + black +
          " dashtype (2,3) title '[u] = u\xE2\x81\xBA \xE2\x88\x92 u\xE2\x81\xBB'";
  text += keys + "\nunset object\nunset label\n";
  return text;
}

}  // namespace

Picture traces_picture(const results::Result& result, const Load& load, std::size_t interface) {
  const results::Trace& trace = load.traces.at(interface);
  const Profile along = profile(result, interface, trace);
  return {
      traces_data(along, trace),
      {result.title, load.name},
      [&, along](Format, const Place& place) { return traces_panel(along, trace, load, place); },
      narrow};
}

}  // namespace anticrack::figures
