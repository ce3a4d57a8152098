// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/mesh_panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

/// Pale, so that lines stand out; neighbours differ.
constexpr std::array<const char*, 6> paints{"#E8F1F8", "#FBEEDD", "#E9F5EC",
                                            "#F5E9F3", "#F6F5DC", "#ECECEC"};

struct Style {
  const char* name;   ///< of the data block
  const char* drawn;  ///< gnuplot's `with`
  const char* legend;
};

// Okabe & Ito; widths and dashes differ as well, for print without colour.
constexpr Style glue{"glue", "lines linewidth 2 linecolor rgb '#0072B2' dashtype (6,4)",
                     "glue, u\xE2\x81\xBA = u\xE2\x81\xBB"};
constexpr Style crack{"crack", "lines linewidth 4 linecolor rgb '#CC79A7' dashtype solid",
                      "crack, [u] \xE2\x89\xA5 0"};
constexpr Style bonded{"bonded", "lines linewidth 6 linecolor rgb '#111111' dashtype solid",
                       "inclusion, bonded"};
constexpr Style delaminated{"delaminated",
                            "lines linewidth 6 linecolor rgb '#D55E00' dashtype solid",
                            "inclusion, delaminated"};
constexpr Style dirichlet{"dirichlet", "lines linewidth 3 linecolor rgb '#444444' dashtype solid",
                          "u given"};
constexpr Style neumann{"neumann", "lines linewidth 4 linecolor rgb '#009E73' dashtype (2,2)",
                        "traction given"};
constexpr Style tips{"tips", "points pointtype 6 pointsize 1.6 linewidth 2 linecolor rgb '#000000'",
                     "tip"};

std::string at(const Spot& spot) {
  return number(spot.x) + " " + number(spot.y) + "\n";
}

std::string block(const std::string& name, const std::string& content) {
  return "$" + name + " << EOD\n" + content + "EOD\n";
}

std::string lines_of(const std::vector<Stretch>& stretches) {
  std::string text;
  for (const Stretch& stretch : stretches) {
    for (const Spot& spot : stretch) text += at(spot);
    text += "\n";
  }
  return text;
}

std::string triangles_of(const std::vector<std::array<Spot, 3>>& triangles) {
  std::string text;
  for (const auto& triangle : triangles) {
    text += at(triangle[0]) + at(triangle[1]) + at(triangle[2]) + at(triangle[0]) + "\n";
  }
  return text;
}

using Layer = std::pair<Style, const std::vector<Stretch>*>;

/// From the lowest to the highest.
std::array<Layer, 6> line_layers(const MeshLayers& layers) {
  return {{{dirichlet, &layers.dirichlet},
           {neumann, &layers.neumann},
           {glue, &layers.interfaces[1]},
           {bonded, &layers.interfaces[3]},
           {delaminated, &layers.interfaces[4]},
           {crack, &layers.interfaces[2]}}};
}

std::string screen(double x, double y, const Place& place) {
  return "screen " + number(place.x + x * place.width) + ", screen " +
         number(place.y + y * place.height);
}

/// The largest box inside the place in which both axes have one scale.
std::string margins(const Window& window, const Place& place, const Canvas& canvas) {
  constexpr double left = 0.09, right = 0.97, bottom = 0.06, top = 0.93;
  const double room_x = (right - left) * place.width * canvas.width;  // pixels
  const double room_y = (top - bottom) * place.height * canvas.height;
  const double scale = std::min(room_x / window.width(), room_y / window.height());
  const double half_x = 0.5 * scale * window.width() / canvas.width;
  const double half_y = 0.5 * scale * window.height() / canvas.height;
  const double middle_x = place.x + 0.5 * (left + right) * place.width;
  const double middle_y = place.y + 0.5 * (bottom + top) * place.height;
  return "set lmargin at screen " + number(middle_x - half_x) + "\nset rmargin at screen " +
         number(middle_x + half_x) + "\nset bmargin at screen " + number(middle_y - half_y) +
         "\nset tmargin at screen " + number(middle_y + half_y) + "\n";
}

std::string drawn_data(const Style& style, const std::string& tag) {
  return std::string(", $") + style.name + tag + " using 1:2 with " + style.drawn + " notitle";
}

std::string labels(const MeshLayers& layers) {
  std::string text;
  for (const PlusSide& side : layers.plus_sides) {
    const bool leftwards = side.from.x - side.to.x > 0.5 * std::abs(side.to.y - side.from.y);
    text += "set arrow from " + number(side.from.x) + "," + number(side.from.y) + " to " +
            number(side.to.x) + "," + number(side.to.y) +
            " head filled size screen 0.008,22 linewidth 2 linecolor rgb '#000000' front\n";
    text += "set label " + figures::quoted(side.name + " +", 40) + " at " + number(side.to.x) +
            "," + number(side.to.y) +
            (leftwards ? " offset -0.6,0 right" : " offset 0.6,0.3 left") +
            " noenhanced textcolor rgb '#000000' front\n";
  }
  for (const auto& [spot, name] : layers.subdomain_names) {
    text += "set label " + figures::quoted(name, 40) + " at " + number(spot.x) + "," +
            number(spot.y) + " center noenhanced textcolor rgb '#555555' front\n";
  }
  return text;
}

}  // namespace

std::string mesh_data(const MeshLayers& layers, const std::string& tag) {
  std::string text;
  for (std::size_t d = 0; d < layers.triangles.size(); ++d) {
    text += block("subdomain" + std::to_string(d) + tag, triangles_of(layers.triangles[d]));
  }
  for (const auto& [style, stretches] : line_layers(layers)) {
    text += block(style.name + tag, lines_of(*stretches));
  }
  std::string points;
  for (const results::Tip& tip : layers.tips) points += at({tip.x, tip.y});
  return text + block(tips.name + tag, points);
}

std::string mesh_panel(const MeshLayers& layers, const MeshPanel& panel, const Canvas& canvas) {
  const Window& window = panel.window;
  std::string text = margins(window, panel.place, canvas);
  text += "unset key\nset border 0\n";
  text += "set tics nomirror textcolor rgb '#333333'\nset xtics autofreq\nset ytics autofreq\n";
  text += "set xrange [" + number(window.x_min) + ":" + number(window.x_max) + "]\n";
  text += "set yrange [" + number(window.y_min) + ":" + number(window.y_max) + "]\n";
  text += "set label 2 " + panel.caption + " at " + screen(0.53, 0.965, panel.place) +
          " center noenhanced textcolor rgb '#222222'\n";
  text += labels(layers);
  std::string plots = "plot NaN notitle";
  for (std::size_t d = 0; panel.with_triangles && d < layers.triangles.size(); ++d) {
    if (layers.triangles[d].empty()) continue;
    const std::string data = ", $subdomain" + std::to_string(d) + panel.tag + " using 1:2 with ";
    plots += data + "filledcurves closed fillcolor rgb '" + paints[d % paints.size()] +
             "' fillstyle solid 1 noborder notitle";
    plots += data + "lines linewidth 0.5 linecolor rgb '#A8A8A8' notitle";
  }
  for (const auto& [style, stretches] : line_layers(layers)) {
    if (!stretches->empty()) plots += drawn_data(style, panel.tag);
  }
  if (!layers.tips.empty()) plots += drawn_data(tips, panel.tag);
  return text + plots + "\nunset label\nunset arrow\n";
}

std::string mesh_legend(const MeshLayers& layers, const Place& place) {
  std::string text = "unset border\nunset tics\nset xrange [0:1]\nset yrange [0:1]\n";
  text += "set lmargin at screen " + number(place.x) + "\nset rmargin at screen " +
          number(place.x + place.width) + "\nset bmargin at screen " + number(place.y) +
          "\nset tmargin at screen " + number(place.y + place.height) + "\n";
  text += "set key at " + screen(0.5, 0.5, place) +
          " center center horizontal maxrows 2 Left reverse samplen 3 width 1 noenhanced\n";
  std::string keys = "plot NaN notitle";
  for (const auto& [style, stretches] : line_layers(layers)) {
    if (!stretches->empty()) {
      keys += std::string(", keyentry with ") + style.drawn + " title '" + style.legend + "'";
    }
  }
  if (!layers.tips.empty()) {
    keys += std::string(", keyentry with ") + tips.drawn + " title '" + tips.legend + "'";
  }
  return text + keys + "\n";
}

}  // namespace anticrack::figures
