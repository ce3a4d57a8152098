// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/pressure.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "figures/axes.hpp"
#include "figures/interface_axis.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {

Pressure pressure(const results::Interface& interface, const results::Trace& trace,
                  const std::vector<double>& position) {
  constexpr double part = 0.9, room = 1.5;
  const auto opens = [&](std::size_t i) {
    return interface.kind[i] == results::Kind::crack ||
           interface.kind[i] == results::Kind::delaminated;
  };
  Pressure found;
  const auto add = [&found](double at, double value, double length) {
    found.position.push_back(at);
    found.values.push_back(value);
    found.lengths.push_back(length);
  };
  std::vector<std::pair<double, double>> closed;
  for (std::size_t a = 0, b = 1; b < interface.node_count(); a = b++) {
    const bool from = opens(a), to = opens(b);
    if (!from && !to) continue;
    if (!from && !found.position.empty()) add(results::unknown, results::unknown, 0);
    // A tip has a flux: half of the edge is its own.
    const double along = !from ? 0.75 : !to ? 0.25 : 0.5;
    const double count = from && to ? 2 : 1;
    const double value = ((from ? trace.pressure[a] : 0) + (to ? trace.pressure[b] : 0)) / count;
    const double length = (interface.s[b] - interface.s[a]) * count / 2;
    add(std::lerp(position[a], position[b], along), value, length);
    if (value > 0 && (trace.contact[a] != 0 || trace.contact[b] != 0))
      closed.emplace_back(value, length);
  }
  found.peaks = peaks(std::move(closed), part, room);
  found.peaks.shown = std::min(found.peaks.shown, found.peaks.highest);
  return found;
}

std::string pressure_panel(const Profile& profile, const std::vector<Pressure>& pressures,
                           const std::vector<PressureCurve>& curves, const results::Units& units,
                           const Place& place, const Box& box) {
  Peaks all;
  for (const Pressure& each : pressures)
    all = {std::max(all.highest, each.peaks.highest), std::max(all.shown, each.peaks.shown)};
  std::string text = margins(place, box.bottom, box.top) + axes() + contact_strips(profile);
  const std::string unit = units.label("F/L");
  if (all.cut_off()) {
    text += "set label 6 " +
            figures::quoted("cut off at the tips, up to " + readable(all.highest, 2) +
                            (unit.empty() ? "" : " " + unit)) +
            " at graph 1, graph 1 right offset 0,0.5 noenhanced font ',7' textcolor " + black +
            " front\n";
  }
  const Range heights{0, 1.06 * all.shown};
  const Scale scale(heights);
  text += axis_range('x', extent(profile), 6, 0, profile.labels) +
          axis_range('y', scale.drawn(heights), 4);
  text += beside(figures::quoted(scale.label("pressure", unit)), place);
  std::string plots;
  for (const PressureCurve& curve : curves) {
    plots += (plots.empty() ? "plot $" : ", $") + curve.block + " using 1:" + scale.column(2) +
             " with lines linewidth 1.5 " + curve.style + " notitle";
  }
  return text + plots + "\nunset object\nunset label\n";
}

}  // namespace anticrack::figures
