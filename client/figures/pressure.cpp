// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/pressure.hpp"

#include <algorithm>
#include <utility>

#include "figures/axes.hpp"
#include "figures/interface_axis.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {

Pressure pressure(const results::Interface& interface, const results::Trace& trace) {
  constexpr double part = 0.9, room = 1.5;
  Pressure found{std::vector<double>(interface.node_count(), results::unknown), {}};
  std::vector<std::pair<double, double>> closed;  // pressure and the length that has it
  for (std::size_t i = 0; i < interface.node_count(); ++i) {
    const results::Kind kind = interface.kind[i];
    if (kind != results::Kind::crack && kind != results::Kind::delaminated) continue;
    found.values[i] = trace.pressure[i];
    if (trace.contact[i] == 0 || !(trace.pressure[i] > 0)) continue;
    const std::size_t before = i == 0 ? i : i - 1;
    const std::size_t after = std::min(i + 1, interface.node_count() - 1);
    closed.emplace_back(trace.pressure[i], interface.s[after] - interface.s[before]);
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
  text += axis_range('x', extent(profile)) + axis_range('y', scale.drawn(heights), 4);
  text += beside(figures::quoted(scale.label("pressure", unit)), place);
  std::string plots;
  for (const PressureCurve& curve : curves) {
    plots += (plots.empty() ? "plot $" : ", $") + curve.block + " using 1:" + scale.column(2) +
             " with lines linewidth 1.5 " + curve.style + " notitle";
  }
  return text + plots + "\nunset object\nunset label\n";
}

}  // namespace anticrack::figures
