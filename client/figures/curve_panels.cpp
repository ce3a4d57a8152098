// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "figures/axes.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;

/// Strips of the graph's whole height or of a bar below the curves, one command a band.
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

}  // namespace

std::string traces_data(const Profile& profile, const results::Trace& trace) {
  std::string text = "$traces << EOD\n";
  for (std::size_t i = 0; i < profile.position.size(); ++i) {
    text += number(profile.position[i]) + " " + number(trace.u_minus[i]) + " " +
            number(trace.u_plus[i]) + " " + number(trace.jump[i]) + "\n";
  }
  return text + "EOD\n";
}

std::string traces_panel(const Profile& profile, const Load& load, const Place& place) {
  const Mark marks[] = {{profile.delaminated, "delaminated inclusion", "rgb '#666666'"},
                        {profile.bonded, "bonded inclusion", "rgb '#111111'"},
                        {profile.crack, "crack", "rgb '#CC79A7'"}};
  std::string text = margins(place, 0.13, 0.96, 0.24, 0.925) + axes();
  std::string keys;
  text += strips(profile.contact, "0", "1",
                 "behind fillcolor " + contact_shade + " fillstyle solid 0.55 noborder");
  if (!profile.contact.empty()) {
    keys += ", keyentry with boxes fillstyle solid 0.55 noborder linecolor " + contact_shade +
            " title 'contact'";
  }
  for (const Mark& mark : marks) {
    text += strips(mark.bands, "0", "0.018",
                   "front fillcolor " + mark.colour + " fillstyle solid 1 noborder");
    if (!mark.bands.empty()) {
      keys += ", keyentry with boxes fillstyle solid 1 noborder linecolor " + mark.colour +
              " title '" + mark.name + "'";
    }
  }
  std::string answer;
  for (const results::Inclusion& inclusion : load.inclusions) {
    answer +=
        (answer.empty() ? "" : ",  ") + std::string("A = ") + readable(inclusion.displacement);
    if (load.inclusions.size() > 1) answer += " (" + inclusion.name + ")";
  }
  text += caption("displacements and jump on " +
                      (profile.name.empty() ? std::string("the interface") : profile.name) +
                      (answer.empty() ? std::string() : ",  " + answer),
                  place);
  const auto [low, high] = std::minmax_element(profile.position.begin(), profile.position.end());
  if (low != high) text += "set xrange [" + number(*low) + ":" + number(*high) + "]\n";
  text += "set offsets 0, 0, graph 0.06, graph 0.06\nset autoscale y\n";
  text += below(quoted(profile.axis), 0.16, place) + "set ylabel 'displacement [-]'\n";
  text += "set key at screen " + number(place.x + 0.54 * place.width) + ", screen " +
          number(place.y + 0.01 * place.height) +
          " center bottom vertical maxrows 3 Left reverse noenhanced samplen 2.5 width 1 height "
          "0.3\n";
  text += "plot 0 with lines linewidth 0.7 linecolor rgb '#888888' notitle, ";
  text += "$traces using 1:2 with lines linewidth 2 linecolor " + blue +
          " dashtype solid title 'u\xE2\x81\xBB'";
  text += ", $traces using 1:3 with lines linewidth 2 linecolor " + vermillion +
          " dashtype (8,4) title 'u\xE2\x81\xBA'";
  text += ", $traces using 1:4 with lines linewidth 2 linecolor " + black +
          " dashtype (2,3) title '[u] = u\xE2\x81\xBA \xE2\x88\x92 u\xE2\x81\xBB'";
  text += keys + "\nunset object\nunset label\n";
  return text;
}

namespace {

/// What the history shows of a method's way to the answer.
struct Series {
  const std::vector<double>* values;
  const char* title;
  const char* style;
};

const char* const blue_solid = "linecolor rgb '#0072B2' dashtype solid";

/// Algorithm 2 has its criterion; the active set has none, it is done when the conditions hold.
std::vector<Series> series_of(const Load& load) {
  const results::History& history = load.history;
  if (load.method != "active-set") {
    return {{&history.criterion, "criterion of step 3", blue_solid}};
  }
  return {
      {&history.kkt_gap, "gap", blue_solid},
      {&history.kkt_sign, "sign", "linecolor rgb '#009E73' dashtype (8,4)"},
      {&history.kkt_complementarity, "complementarity", "linecolor rgb '#222222' dashtype (2,3)"}};
}

bool drawable(double value) {
  return value > 0 && std::isfinite(value);
}

bool has_epsilon(const Load& load) {
  return drawable(load.epsilon);
}

/// Smallest positive number to be drawn.
double lowest(const Load& load) {
  double least = has_epsilon(load) ? load.epsilon : 1;
  for (const Series& series : series_of(load)) {
    for (const double value : *series.values) {
      if (drawable(value)) least = std::min(least, value);
    }
  }
  return std::max(least, 1e-300);
}

std::string counted(const Load& load) {
  const std::string unit = load.method == "active-set" ? " step" : " iteration";
  return std::to_string(load.iterations) + unit + (load.iterations == 1 ? "" : "s");
}

}  // namespace

bool has_convergence(const Load& load) {
  for (const Series& series : series_of(load)) {
    if (std::any_of(series.values->begin(), series.values->end(), drawable)) return true;
  }
  return false;
}

std::string convergence_data(const Load& load) {
  std::string text = "$history << EOD\n";
  for (std::size_t i = 0; i < load.history.size(); ++i) {
    text += std::to_string(load.history.iteration[i]);
    // A log axis has no place for zero; what cannot be drawn leaves a gap.
    for (const Series& series : series_of(load)) {
      const double value = (*series.values)[i];
      text += " " + (value > 0 ? number(value) : std::string("NaN"));
    }
    text += "\n";
  }
  return text + "EOD\n";
}

std::string convergence_panel(const Load& load, const Place& place) {
  const bool steps = load.method == "active-set";
  std::string text = margins(place, 0.12, 0.96, 0.19, 0.925) + axes();
  std::string how(results::name(load.status));
  std::replace(how.begin(), how.end(), '_', ' ');
  how += " after " + counted(load);
  if (std::isfinite(load.theta)) how += ",  \xCE\xB8 = " + readable(load.theta);
  if (std::isfinite(load.theta_star)) how += ",  \xCE\xB8* = " + readable(load.theta_star);
  text += caption(how, place);
  text += "set logscale y\nset format y '10^{%T}'\n";
  text += below(steps ? "'step of the active set'" : "'iteration'", 0.11, place);
  text += steps ? "set ylabel 'KKT residual [-]'\n"
                : "set ylabel 'relative change of u, squared [-]'\n";
  text += "set xrange [0:" + number(load.history.size() == 0 ? 1 : load.history.iteration.back()) +
          "]\n";
  text += "set yrange [" + number(0.1 * lowest(load)) + ":*]\n";
  text += "set key at screen " + number(place.x + 0.54 * place.width) + ", screen " +
          number(place.y + 0.01 * place.height) +
          " center bottom vertical maxrows 1 Left reverse samplen 2.5\n";
  std::string plots;
  int column = 2;
  for (const Series& series : series_of(load)) {
    plots += (plots.empty() ? "plot $history using 1:" : ", $history using 1:") +
             std::to_string(column++) + " with " +
             (steps ? "linespoints pointtype 7 pointsize 0.8" : "lines") + " linewidth 2 " +
             series.style + " title '" + series.title + "'";
  }
  text += plots;
  if (has_epsilon(load)) {
    text += ", " + number(load.epsilon) + " with lines linewidth 1.5 linecolor " + vermillion +
            " dashtype (8,4) title '\xCE\xB5 = " + readable(load.epsilon) + "'";
  }
  text += "\nunset label\n";
  return text;
}

}  // namespace anticrack::figures
