// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "figures/interface_axis.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;

std::string block(std::size_t load) { return "load" + std::to_string(load); }

std::string colour_of(std::size_t load) {
  return std::string("linecolor rgb '") + curve_styles.at(load).colour + "'";
}

std::string dashed(std::size_t load) {
  return colour_of(load) + " dashtype " + curve_styles.at(load).dash;
}

std::string curve(std::size_t load, const Scale& scale, int column, const std::string& style) {
  return ", $" + block(load) + " using 1:" + scale.column(column) + " with lines linewidth 1.5 " +
         style + " notitle";
}

/// Panels over one axis, from the top; heights in mm.
struct Heights {
  static constexpr double pressure = 28, panel = 38, gap = 4, head = 7;
  int rows;  ///< of the legend, in two columns
  double foot, total, above_pressure;

  Heights(int entries, bool in_contact)
      : rows((entries + 1) / 2),
        foot(11.5 + 3.2 * rows),
        total(foot + 2 * panel + gap + head + (in_contact ? pressure + gap : 0)),
        above_pressure(foot + (in_contact ? pressure + gap : 0)) {}
  Box box(double bottom, double height) const {
    return {bottom / total, (bottom + height) / total};
  }
};

}  // namespace

Picture together_picture(const results::Result& result, std::size_t interface) {
  // Contact differs from load to load: no shade is that of all.
  results::Trace open;
  open.contact.assign(result.interfaces.at(interface).node_count(), 0);
  const Profile along = profile(result, interface, open);
  const results::Units units = result.units;
  std::string data;
  std::vector<const results::Trace*> traces;
  std::vector<Pressure> pressures;
  std::vector<PressureCurve> pressure_curves;
  double energy = 0;
  bool in_contact = false;
  for (std::size_t l = 0; l < result.loads.size(); ++l) {
    const Load& load = result.loads[l];
    traces.push_back(&load.traces.at(interface));
    pressures.push_back(pressure(result.interfaces[interface], *traces.back(), along.position));
    pressure_curves.push_back({"pressure" + std::to_string(l), dashed(l)});
    data += data_block(block(l), {&along.position, &traces.back()->jump, &traces.back()->u_minus,
                                  &traces.back()->u_plus});
    data += data_block(pressure_curves.back().block,
                       {&pressures.back().position, &pressures.back().values});
    if (std::isfinite(load.energy)) energy = std::max(energy, std::abs(load.energy));
    in_contact = in_contact || pressures.back().peaks.highest > 0;
  }
  const Keys parts = part_keys(along);
  const Heights sizes(static_cast<int>(traces.size()) + parts.count, in_contact);
  const auto plots = [=, &result](Format, const Place& place) {
    const auto panel = [&](const Range& range, const std::string& name, double bottom) {
      const Scale scale(range);
      const Box box = sizes.box(bottom, Heights::panel);
      return margins(place, box.bottom, box.top) + axes() +
             axis_range('x', extent(along), 6, 0, along.labels) +
             axis_range('y', scale.drawn(range), 6) +
             beside(figures::quoted(scale.label(name, units.label("L"))), place);
    };
    const Range all = with_bars(heights(traces, energy), along);
    const std::string ground = "plot 0 with lines linewidth 0.7 linecolor rgb '#888888' notitle";
    Range jumps{0, 0};
    std::string jump_curves, u_curves, keys;
    for (const results::Trace* trace : traces)
      for (const double value : trace->jump) jumps.include(value);
    if (jumps.size() < 1e-9 * all.size()) jumps = all;
    jumps = {jumps.low - 0.06 * jumps.size(), jumps.high + 0.06 * jumps.size()};
    for (std::size_t l = 0; l < traces.size(); ++l) {
      jump_curves += curve(l, Scale(jumps), 2, dashed(l));
      u_curves += curve(l, Scale(all), 3, colour_of(l) + " dashtype solid");
      u_curves += curve(l, Scale(all), 4, colour_of(l) + " dashtype (8,4)");
      keys += ", keyentry with lines linewidth 1.5 " + dashed(l) + " title " +
              figures::quoted(result.loads[l].name, 24);
    }
    std::string text = "set format x ''\n" + legend(sizes.rows, place);
    text += caption(along.name.empty() ? std::string("the interface under each load")
                                       : "interface " + shortened(along.name, 30),
                    place, 1 - 3 / sizes.total);
    text += panel(jumps, "[u]", sizes.above_pressure + Heights::panel + Heights::gap) + ground +
            jump_curves + keys + parts.plots + "\nunset label\nunset key\n";
    if (!in_contact)
      text += "set format x\n" +
              below(figures::quoted(along.axis), (sizes.foot - 7) / sizes.total, place);
    text += part_bars(along) +
            panel(all, "u\xE2\x81\xBB solid, u\xE2\x81\xBA dashed", sizes.above_pressure) + ground +
            u_curves + "\nunset object\nunset label\n";
    if (!in_contact) return text;
    return text + "set format x\n" +
           below(figures::quoted(along.axis), (sizes.foot - 7) / sizes.total, place) +
           pressure_panel(along, pressures, pressure_curves, units, place,
                          sizes.box(sizes.foot, Heights::pressure));
  };
  return {data, {result.title, ""}, plots, {85, sizes.total}};
}

}  // namespace anticrack::figures
