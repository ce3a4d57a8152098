// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "figures/axes.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;

/// What the history shows of a method's way to the answer.
struct Series {
  const std::vector<double>* values;
  const char* title;
  std::string style;
};

const std::string blue_solid = "linecolor " + blue + " dashtype solid";

/// Algorithm 2 has its criterion; the active set has none, it is done when the conditions hold.
std::vector<Series> series_of(const Load& load) {
  const results::History& history = load.history;
  if (load.method != "active-set")
    return {{&history.criterion, "of u in the energy norm, squared", blue_solid}};
  return {
      {&history.kkt.gap, "gap: faces overlap", blue_solid},
      {&history.kkt.sign, "sign: closed faces pull", "linecolor " + vermillion + " dashtype (8,4)"},
      {&history.kkt.complementarity, "complementarity: pressure where open",
       "linecolor " + black + " dashtype (2,3)"}};
}

bool drawable(double value) { return value > 0 && std::isfinite(value); }

bool has_epsilon(const Load& load) { return drawable(load.epsilon); }

/// The power of ten below all that is drawn.
double foot(const Load& load) {
  double least = has_epsilon(load) ? load.epsilon : 1;
  for (const Series& series : series_of(load)) {
    for (const double value : *series.values)
      if (drawable(value)) least = std::min(least, value);
  }
  return std::pow(10.0, std::floor(std::log10(std::max(least, 1e-300)) - 0.5));
}

bool has_zero(const Load& load) {
  for (const Series& series : series_of(load))
    if (std::count(series.values->begin(), series.values->end(), 0.0) > 0) return true;
  return false;
}

std::string counted(const Load& load) {
  const std::string unit = load.method == "active-set" ? " step" : " iteration";
  return std::to_string(load.iterations) + unit + (load.iterations == 1 ? "" : "s");
}

std::string convergence_data(const Load& load) {
  const double zero = foot(load);
  std::string text = "$history << EOD\n";
  for (std::size_t i = 0; i < load.history.size(); ++i) {
    text += std::to_string(load.history.iteration[i]);
    for (const Series& series : series_of(load)) {
      const double value = (*series.values)[i];
      text += " " + (drawable(value) ? number(value)
                     : value == 0    ? number(zero)
                                     : std::string("NaN"));
    }
    text += "\n";
  }
  return text + "EOD\n";
}

std::string convergence_panel(const Load& load, const Place& place) {
  constexpr std::size_t few = 60;  // iterations that are points, too
  const bool steps = load.method == "active-set";
  std::string text = margins(place, 0.28, 0.905) + axes();
  std::string how(results::name(load.status));
  std::replace(how.begin(), how.end(), '_', ' ');
  how += " after " + counted(load);
  if (std::isfinite(load.theta)) how += ",  \xCE\xB8 = " + readable(load.theta);
  if (std::isfinite(load.theta_star)) how += ",  \xCE\xB8* = " + readable(load.theta_star);
  text += caption(how, place);
  text += "set logscale y\nset format y '10^{%T}'\nset ytics autofreq\n";
  text += below(steps ? "'step of the active set'" : "'iteration'", 0.175, place);
  text += beside(steps ? "'KKT residual'" : "'relative change per iteration'", place);
  const double last = load.history.size() == 0 ? 1 : load.history.iteration.back();
  text += axis_range('x', {0, last}, std::min(6, static_cast<int>(last)));
  const double lowest = foot(load);
  text += "set yrange [" + number(0.5 * lowest) + ":*]\n";
  if (has_zero(load)) text += "set ytics add ('0' " + number(lowest) + ")\n";
  text += legend(3, place);
  const std::string with =
      load.history.size() <= few ? " with linespoints pointtype 7 pointsize 0.4" : " with lines";
  std::string plots;
  int data_column = 2;
  for (const Series& series : series_of(load)) {
    plots += (plots.empty() ? "plot $history using 1:" : ", $history using 1:") +
             std::to_string(data_column++) + with + " linewidth 1.5 " + series.style + " title '" +
             series.title + "'";
  }
  text += plots;
  if (has_epsilon(load)) {
    text += ", " + number(load.epsilon) + " with lines linewidth 1.2 linecolor " + vermillion +
            " dashtype (8,4) title '\xCE\xB5 = " + readable(load.epsilon) + "'";
  }
  text += "\nunset label\n";
  return text;
}

}  // namespace

bool has_convergence(const Load& load) { return load.history.size() > 2; }

Picture convergence_picture(const results::Result& result, const Load& load) {
  return {convergence_data(load),
          {result.title, load.name},
          [&](Format, const Place& place) { return convergence_panel(load, place); },
          narrow};
}

}  // namespace anticrack::figures
