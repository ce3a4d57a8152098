// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/mesh_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "figures/axes.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

/// Pale, so that lines stand out; neighbours differ.
constexpr std::array<const char*, 6> paints{"#E8F1F8", "#FBEEDD", "#E9F5EC",
                                            "#F5E9F3", "#F6F5DC", "#ECECEC"};

struct Style {
  const char* name;   ///< of the data block
  std::string drawn;  ///< gnuplot's `with`
  const char* legend;
  bool edged = false;  ///< in white, against dense triangles, which are as dark
};

// Widths and dashes differ as well, for print without colour.
const Style glue{"glue", "lines linewidth 1.2 linecolor " + blue + " dashtype (6,4)",
                 "glue, u\xE2\x81\xBA = u\xE2\x81\xBB"};
const Style crack{"crack", "lines linewidth 2.5 linecolor " + crack_colour + " dashtype solid",
                  "crack, [u] \xE2\x89\xA5 0", true};
const Style free_crack{"free", "lines linewidth 2.5 linecolor " + free_colour + " dashtype solid",
                       "free crack", true};
const Style bonded{"bonded", "lines linewidth 3.5 linecolor " + bonded_colour + " dashtype solid",
                   "bonded inclusion", true};
const Style delaminated{"delaminated",
                        "lines linewidth 3.5 linecolor " + delaminated_colour + " dashtype solid",
                        "delaminated inclusion", true};
const Style dirichlet{"dirichlet", "lines linewidth 1.8 linecolor rgb '#444444' dashtype solid",
                      "u given"};
const Style neumann{"neumann", "lines linewidth 2.5 linecolor " + green + " dashtype (2,2)",
                    "free or traction"};
const Style contours{"contours", "lines linewidth 0.6 linecolor rgb '#333333' dashtype solid",
                     "u = const"};
const Style loose{"loose", "lines linewidth 1.5 linecolor rgb '#D00000' dashtype (2,2)",
                  "the side that came off"};
const Style starts{"starts", "points pointtype 4 pointsize 0.6 linewidth 1 linecolor " + blue,
                   "s = 0"};
const Style tips{"tips", "points pointtype 6 pointsize 0.5 linewidth 1 linecolor rgb '#000000'",
                 "tip"};

std::string at(const Spot& spot) { return number(spot.x, 12) + " " + number(spot.y, 12) + "\n"; }

std::string mesh_block(const std::string& name, const std::string& content) {
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
  for (const auto& triangle : triangles)
    text += at(triangle[0]) + at(triangle[1]) + at(triangle[2]) + at(triangle[0]) + "\n";
  return text;
}

std::string points_of(const std::vector<Spot>& spots) {
  std::string text;
  for (const Spot& spot : spots) text += at(spot);
  return text;
}

using Layer = std::pair<Style, const std::vector<Stretch>*>;

/// From the lowest to the highest.
std::array<Layer, 9> line_layers(const MeshLayers& layers) {
  return {{{contours, &layers.contours},
           {dirichlet, &layers.dirichlet},
           {neumann, &layers.neumann},
           {glue, &layers.interfaces[1]},
           {bonded, &layers.interfaces[3]},
           {delaminated, &layers.interfaces[4]},
           {loose, &layers.loose},
           {free_crack, &layers.interfaces[5]},
           {crack, &layers.interfaces[2]}}};
}

/// Those of the legend.
std::vector<Style> shown_styles(const MeshLayers& layers) {
  std::vector<Style> styles;
  for (const auto& [style, stretches] : line_layers(layers)) {
    if (stretches->empty()) continue;
    styles.push_back(style);
    if (stretches == &layers.neumann && layers.free) styles.back().legend = "free";
  }
  if (!layers.tips.empty()) styles.push_back(tips);
  if (!layers.starts.empty()) styles.push_back(starts);
  return styles;
}

/// Of a place.
struct Sides {
  double left, right, bottom, top;
};

/// The largest box inside the place in which both axes have one scale; `height` of the picture, in
/// widths of it.
Sides sides_of(const Window& window, const Place& place, double height) {
  constexpr Sides most{0.2, 0.97, 0.145, 0.92};
  const double room_x = (most.right - most.left) * place.width;
  const double room_y = (most.top - most.bottom) * place.height * height;
  const double scale = std::min(room_x / window.width(), room_y / window.height());
  const double half_x = 0.5 * scale * window.width() / place.width;
  const double half_y = 0.5 * scale * window.height() / (place.height * height);
  constexpr double x = 0.5 * (most.left + most.right), y = 0.5 * (most.bottom + most.top);
  return {x - half_x, x + half_x, y - half_y, y + half_y};
}

std::string drawn_data(const Style& style, const std::string& tag) {
  return std::string(", $") + style.name + tag + " using 1:2 with " + style.drawn + " notitle";
}

std::string label(const std::string& name, const Spot& spot, const std::string& where,
                  const std::string& colour) {
  return "set label " + figures::quoted(name, 24) + " at " + number(spot.x, 12) + "," +
         number(spot.y, 12) + " " + where + " noenhanced font ',7' textcolor rgb '" + colour +
         "' front boxed\n";
}

/// At the end of an arrow, on its far side.
std::string beyond(const Pointer& pointer) {
  const double dx = pointer.to.x - pointer.from.x;
  const double dy = pointer.to.y - pointer.from.y;
  if (pointer.sideways()) return dx < 0 ? "right offset -0.6,0" : "left offset 0.6,0";
  return "center offset 0," + std::string(dy < 0 ? "-0.6" : "0.6");
}

std::string labels(const MeshLayers& layers) {
  std::string text = light_boxes;
  for (const Pointer& side : layers.plus_sides) {
    text += "set arrow from " + number(side.from.x, 12) + "," + number(side.from.y, 12) + " to " +
            number(side.to.x, 12) + "," + number(side.to.y, 12) +
            " head filled size screen 0.008,22 linewidth 1.2 linecolor rgb '#000000' front\n";
    text += label(side.name, side.to, beyond(side), "#000000");
  }
  for (const Pointer& inclusion : layers.inclusions)
    text += label(inclusion.name, inclusion.to, beyond(inclusion), "#000000");
  for (const auto* names : {&layers.subdomain_names, &layers.levels})
    for (const auto& [spot, name] : *names) text += label(name, spot, "center", "#555555");
  return text;
}

}  // namespace

std::string mesh_data(const MeshLayers& layers, const std::string& tag) {
  std::string text;
  for (std::size_t d = 0; d < layers.triangles.size(); ++d)
    text += mesh_block("subdomain" + std::to_string(d) + tag, triangles_of(layers.triangles[d]));
  for (const auto& [style, stretches] : line_layers(layers))
    text += mesh_block(style.name + tag, lines_of(*stretches));
  std::vector<Spot> spots;
  for (const results::Tip& tip : layers.tips) spots.push_back({tip.x, tip.y});
  return text + mesh_block(tips.name + tag, points_of(spots)) +
         mesh_block(starts.name + tag, points_of(layers.starts));
}

std::string mesh_panel(const MeshLayers& layers, const MeshPanel& panel, const Place& place,
                       double height) {
  const Window& window = panel.window;
  const std::string length = panel.units.label("L");
  const Sides box = sides_of(window, place, height);
  std::string text = margins(place, box.left, box.right, box.bottom, box.top) + axes();
  text += "unset key\nset border 0\nunset grid\nset tics out\n";
  // A short side has no room for as many labels.
  const Range x{window.x_min, window.x_max}, y{window.y_min, window.y_max};
  const double extent = std::max(x.size(), y.size()), step = label_step({0, extent}, 5);
  text +=
      axis_range('x', x, 5, step, Scale(x, extent)) + axis_range('y', y, 5, step, Scale(y, extent));
  const auto name = [&](const char* axis, const Range& range) {
    return figures::quoted(Scale(range, extent).label(axis, length));
  };
  text += below(name("x", x), box.bottom - 0.125, place) + beside(name("y", y), place) +
          caption(panel.caption, place);
  text += labels(layers);
  std::string plots = "plot NaN notitle";
  for (std::size_t d = 0; panel.with_triangles && d < layers.triangles.size(); ++d) {
    if (layers.triangles[d].empty()) continue;
    const std::string data = ", $subdomain" + std::to_string(d) + panel.tag + " using 1:2 with ";
    const bool painted = !panel.paints.empty();
    const std::string paint = painted ? panel.paints.at(d) : paints[d % paints.size()];
    plots += data + "filledcurves closed fillcolor rgb '" + paint +
             "' fillstyle solid 1 noborder notitle";
    // Without edges of its colour what lies behind shines through between the triangles.
    plots +=
        data + "lines linewidth 0.3 linecolor rgb '" + (painted ? paint : "#A8A8A8") + "' notitle";
  }
  for (const auto& [style, stretches] : line_layers(layers)) {
    if (stretches->empty()) continue;
    if (style.edged) {
      plots += std::string(", $") + style.name + panel.tag +
               " using 1:2 with lines linewidth 5 linecolor rgb '#FFFFFF' notitle";
    }
    plots += drawn_data(style, panel.tag);
  }
  if (!layers.tips.empty()) plots += drawn_data(tips, panel.tag);
  if (!layers.starts.empty()) plots += drawn_data(starts, panel.tag);
  // Out of sight, for the colour bar.
  if (!panel.paints.empty()) plots += ", '+' using (NaN):(NaN):(0) with points palette notitle";
  return text + plots + "\nunset label\nunset arrow\n";
}

int legend_rows(const MeshLayers& layers, int columns) {
  return (static_cast<int>(shown_styles(layers).size()) + columns - 1) / columns;
}

std::string mesh_legend(const MeshLayers& layers, int rows, const Place& place) {
  std::string text = "unset border\nunset tics\nunset xlabel\nunset ylabel\n";
  text += "set xrange [0:1]\nset yrange [0:1]\n" + figures::margins(place, 0, 1, 0, 1);
  text += legend(rows, place);
  std::string keys = "plot NaN notitle";
  for (const Style& style : shown_styles(layers))
    keys += std::string(", keyentry with ") + style.drawn + " title '" + style.legend + "'";
  return text + keys + "\n";
}

}  // namespace anticrack::figures
