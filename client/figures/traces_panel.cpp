// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "figures/interface_axis.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;

/// A and B of the inclusions here.
std::string answers(const Profile& profile, const Load& load, const std::string& unit,
                    bool with_bounds) {
  std::string answer;
  for (const results::Inclusion& inclusion : load.inclusions) {
    const bool here =
        std::any_of(profile.fibres.begin(), profile.fibres.end(),
                    [&](const Fibre& fibre) { return fibre.inclusion == inclusion.name; });
    if (!here) continue;
    answer += ",  A = " +
              (with_bounds && std::isfinite(inclusion.displacement_lower)
                   ? bounded(inclusion.displacement_lower, inclusion.displacement_upper)
                   : readable(inclusion.displacement)) +
              (unit.empty() ? "" : " " + unit);
    if (inclusion.tilted()) {
      answer += ", B = (" + readable(inclusion.slope_x) + ", " + readable(inclusion.slope_y) + ")";
    }
    if (load.inclusions.size() > 1 && inclusion.name != profile.name)
      answer += " (" + shortened(inclusion.name, 12) + ")";
  }
  if (load.status == results::Status::not_converged) answer += ",  not converged";
  return answer;
}

std::string traces_heading(const Profile& profile, const Load& load, const std::string& unit) {
  constexpr std::size_t most = 50;
  const std::string where =
      profile.name.empty() ? std::string("the interface") : shortened(profile.name, 20);
  const std::string bounds = where + answers(profile, load, unit, true);
  const std::string full = "displacements on " + bounds;
  if (length(full) <= most) return full;
  return length(bounds) <= most ? bounds : where + answers(profile, load, unit, false);
}

std::string curve(const std::string& column, const std::string& style, const char* title) {
  return " using 1:" + column + " with lines linewidth 1.5 " + style + " title '" + title + "'";
}

/// Without the label of the horizontal axis.
std::string displacements(const Profile& profile, const results::Trace& trace, const Load& load,
                          const results::Units& units, const Place& place, const Box& box) {
  const Range high = with_bars(heights({&trace}, load.energy), profile);
  const Scale scale(high);
  const Keys keys = part_keys(profile);
  std::string text = margins(place, box.bottom, box.top) + axes();
  text += contact_strips(profile) + part_bars(profile);
  text += axis_range('x', extent(profile), 6, 0, profile.labels) +
          axis_range('y', scale.drawn(high), 9);
  text += caption(traces_heading(profile, load, units.label("L")), place);
  text += beside(figures::quoted(scale.label("displacement", units.label("L"))), place);
  text += legend((keys.count + 4) / 2, place);
  text += "plot 0 with lines linewidth 0.7 linecolor rgb '#888888' notitle";
  const std::string data = ", $traces";
  text += data + curve(scale.column(2), "linecolor " + blue + " dashtype solid", "u\xE2\x81\xBB");
  text +=
      data + curve(scale.column(3), "linecolor " + vermillion + " dashtype (8,4)", "u\xE2\x81\xBA");
  text += data + curve(scale.column(4), "linecolor " + black + " dashtype (2,3)",
                       "[u] = u\xE2\x81\xBA \xE2\x88\x92 u\xE2\x81\xBB");
  return text + keys.plots + "\nunset object\nunset label\n";
}

}  // namespace

Range heights(const std::vector<const results::Trace*>& traces, double energy) {
  Range range{0, 0};
  for (const results::Trace* trace : traces)
    for (const auto* values : {&trace->u_minus, &trace->u_plus, &trace->jump})
      for (const double value : *values) range.include(value);
  const double typical = std::isfinite(energy) ? std::sqrt(std::abs(energy)) : 0;
  if (range.size() < 1e-9 * typical) {
    const double power = std::pow(10.0, std::floor(std::log10(typical)));
    range = {-power, power};
  }
  return range;
}

TracesPanels traces_panels(const results::Result& result, const Load& load, std::size_t interface) {
  const results::Trace& trace = load.traces.at(interface);
  const Profile along = profile(result, interface, trace);
  const Pressure pressed = pressure(result.interfaces[interface], trace, along.position);
  const std::string axis = figures::quoted(along.axis);
  const results::Units units = result.units;
  const bool in_contact = pressed.peaks.highest > 0;
  return {data_block("traces", {&along.position, &trace.u_minus, &trace.u_plus, &trace.jump}),
          in_contact ? data_block("pressure", {&pressed.position, &pressed.values}) : "",
          [=, &trace, &load](const Place& place, const Box& box) {
            return displacements(along, trace, load, units, place, box);
          },
          [=](const Place& place, const Box& box) {
            return pressure_panel(along, {pressed}, {{"pressure", "linecolor " + green}}, units,
                                  place, box);
          },
          [=](double height, const Place& place) { return below(axis, height, place); },
          along.name,
          in_contact};
}

Picture traces_picture(const results::Result& result, const Load& load, std::size_t interface) {
  const TracesPanels panels = traces_panels(result, load, interface);
  const Title title{result.title, load.name};
  if (!panels.in_contact) {
    return {panels.data, title,
            [=](Format, const Place& place) {
              return panels.axis_label(0.2, place) + panels.displacements(place, {0.305, 0.905});
            },
            narrow};
  }
  return {panels.data + panels.pressure_data, title,
          [=](Format, const Place& place) {
            return "set format x ''\n" + panels.displacements(place, {0.48, 0.93}) +
                   "unset key\nset format x\n" + panels.axis_label(0.135, place) +
                   panels.pressure(place, {0.2, 0.445});
          },
          tall};
}

}  // namespace anticrack::figures
