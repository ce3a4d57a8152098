// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "figures/axes.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;
using results::Stages;

/// Of a stage; the errors are relative.
struct Bounds {
  double triangles, energy, lower, upper, error, displacement_error;
};

std::vector<Bounds> bounds_of(const Stages& stages) {
  std::vector<Bounds> all;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double lower = stages.energy_lower[i], upper = stages.energy_upper[i];
    const double error = (upper - lower) / std::abs(stages.energy[i]);
    // Zero and what is unknown have no place on a log axis.
    if (stages.triangles[i] <= 0 || !(error > 0) || !std::isfinite(error)) continue;
    const double of_a = stages.displacement_error[i];
    all.push_back({static_cast<double>(stages.triangles[i]), stages.energy[i], lower, upper, error,
                   of_a > 0 ? of_a : results::unknown});
  }
  return all;
}

std::string accuracy_data(const std::vector<Bounds>& stages) {
  const Bounds& last = stages.back();
  std::string text = "$stages << EOD\n";
  for (const Bounds& at : stages) {
    for (const double value : {at.triangles, at.error, at.displacement_error, at.lower, at.upper,
                               at.energy, last.error * last.triangles / at.triangles})
      text += number(value) + " ";
    text += "\n";
  }
  return text + "EOD\n";
}

bool has_displacement(const std::vector<Bounds>& stages) {
  return std::ranges::any_of(stages,
                             [](const Bounds& at) { return std::isfinite(at.displacement_error); });
}

Range triangles_of(const std::vector<Bounds>& stages) {
  return {stages.front().triangles, stages.back().triangles};
}

std::string heading(const std::vector<Bounds>& stages) {
  const Bounds& last = stages.back();
  const std::string of_a = std::isfinite(last.displacement_error)
                               ? ", A " + readable(100 * last.displacement_error, 2) + " %"
                               : "";
  return "energy " + readable(100 * last.error, 2) + " %" + of_a + " on " +
         readable(last.triangles, 7) + " triangles, " + std::to_string(stages.size()) + " stages";
}

std::string curve(int column, const std::string& style, const std::string& title) {
  return "$stages using 1:" + std::to_string(column) +
         " with linespoints pointtype 7 pointsize 0.4 linewidth 1.5 " + style + " title '" + title +
         "'";
}

std::string legend_at(double height, const Place& place) {
  return "set key at screen " + number(place.x + 0.54 * place.width) + ", screen " +
         number(place.y + height * place.height) +
         " center top vertical maxrows 3 Left reverse noenhanced samplen 2.5 font ',7'\n";
}

/// `legend_height`: of its upper end.
std::string errors_panel(const std::vector<Bounds>& stages, const Place& place, const Box& box,
                         double legend_height, bool with_axis) {
  Range errors = empty_range();
  for (const Bounds& at : stages) {
    errors.include(at.error);
    errors.include(at.displacement_error);
  }
  std::string text = margins(place, box.bottom, box.top) + axes() + caption(heading(stages), place);
  text += log_axis('x', triangles_of(stages), with_axis) + log_axis('y', errors);
  text += beside("'relative error bound'", place) + legend_at(legend_height, place);
  text +=
      "plot $stages using 1:7 with lines linewidth 0.7 linecolor rgb '#888888' dashtype solid "
      "title 'as 1 / triangles', ";
  text += curve(2, "linecolor " + blue + " dashtype solid", "energy, width of its bounds");
  if (has_displacement(stages)) {
    text += ", " + curve(3, "linecolor " + vermillion + " dashtype (8,4)",
                         "A, half the width of its bounds");
  }
  return text + "\nunset label\nunset logscale\n";
}

std::string bracket_panel(const std::vector<Bounds>& stages, const std::string& unit,
                          const Place& place) {
  Range energies = empty_range();
  for (const Bounds& at : stages)
    for (const double value : {at.lower, at.upper, at.energy}) energies.include(value);
  const double room = 0.06 * energies.size();
  energies = {energies.low - room, energies.high + room};
  const Scale scale(energies);
  std::string text = margins(place, 0.19, 0.465) + axes();
  text += log_axis('x', triangles_of(stages)) + axis_range('y', scale.drawn(energies), 6);
  text += below("'triangles'", 0.125, place) +
          beside(figures::quoted(scale.label("energy", unit)), place);
  text += legend_at(0.095, place);
  text += "plot $stages using 1:" + scale.column(4) + ":" + scale.column(5) +
          " with filledcurves fillcolor " + contact_shade +
          " fillstyle solid 1 noborder title 'bounds of the membrane\xE2\x80\x99s energy', ";
  text += "$stages using 1:" + scale.column(6) +
          " with linespoints pointtype 7 pointsize 0.4 linewidth 1.5 linecolor " + blue +
          " dashtype solid title 'energy on the mesh of the stage'";
  return text + "\nunset label\nunset logscale\n";
}

}  // namespace

std::size_t bounded_stages(const Load& load) { return bounds_of(load.stages).size(); }

Picture errors_picture(const results::Result& result, const Load& load) {
  const std::vector<Bounds> stages = bounds_of(load.stages);
  return {accuracy_data(stages),
          {result.title, load.name},
          [stages](Format, const Place& place) {
            return below("'triangles'", 0.2, place) +
                   errors_panel(stages, place, {0.305, 0.905}, 0.15, true);
          },
          narrow};
}

Picture accuracy_picture(const results::Result& result, const Load& load) {
  const std::vector<Bounds> stages = bounds_of(load.stages);
  return {accuracy_data(stages),
          {result.title, load.name},
          [stages, energy = result.units.label("F L")](Format, const Place& place) {
            return errors_panel(stages, place, {0.605, 0.935}, 0.592, false) +
                   bracket_panel(stages, energy, place);
          },
          tall};
}

}  // namespace anticrack::figures
