// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>

#include "figures/palette.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

/// Colours of u; zero is in the middle where u has both signs.
struct Shades {
  Palette palette = viridis;
  Range range;
};

Shades shades_of(const Surface& surface) {
  const double largest = surface.largest();
  if (largest == 0) return {viridis, {-1, 1}};
  if (std::min(-surface.lowest, surface.highest) > 0.05 * largest)
    return {diverging, {-largest, largest}};
  return {viridis, {surface.lowest, surface.highest}};
}

std::string membrane_heading(double factor, const results::Load& load) {
  std::string text = factor == 1 ? std::string("deformed membrane, u to scale")
                                 : "deformed membrane, u amplified \xC3\x97" + readable(factor);
  if (load.status == results::Status::not_converged) text += ",  not converged";
  return text;
}

std::string space_label(int tag, const std::string& quoted_text, const Vertex& at,
                        const std::string& more = {}) {
  return "set label " + std::to_string(tag) + " " + quoted_text + " at first " + number(at.x, 12) +
         ", first " + number(at.y, 12) + ", first " + number(at.u) + " center noenhanced" + more +
         "\n";
}

/// Whether the side of the lowest y is near the viewer, as gnuplot's x axis is.
bool sees_low_y(double view) { return view < 90 || view > 270; }

/// A short side has no room for as many labels, the near corner for one and not for two.
std::string label_steps(const Surface& surface, double view) {
  const double least = label_step({0, surface.width()}, 6);
  const auto step = [&](double low, double high) {
    return std::max(least, label_step({low, high}, 4));
  };
  const double y_step = step(surface.y_min, surface.y_max);
  const double low = surface.y_min + (sees_low_y(view) ? 0.4 * y_step : 0);
  const double high = surface.y_max - (sees_low_y(view) ? 0 : 0.4 * y_step);
  const Range x{surface.x_min, surface.x_max}, y{surface.y_min, surface.y_max};
  return tics('x', x, step(x.low, x.high), Scale(x, surface.width())) +
         " nomirror offset 0,-0.3\n" +
         tics('y', low < high ? Range{low, high} : y, y_step, Scale(y, surface.width())) +
         " nomirror offset 0.3,-0.2\n";
}

/// Of a triangle, by the mean slope around its corners: by its own, neighbours would differ and the
/// triangles be seen. The light comes from the upper left of a viewer at `view` degrees.
double brightness(const Triangle& triangle, double factor, double view) {
  constexpr double to_right = -0.5, away = -0.3, up = 0.81;
  const double angle = view * std::numbers::pi / 180;
  double x = 0, y = 0;
  for (const Vertex& vertex : triangle) {
    x -= factor * vertex.slope_x / 3;
    y -= factor * vertex.slope_y / 3;
  }
  const double lit = (x * (to_right * std::cos(angle) - away * std::sin(angle)) +
                      y * (to_right * std::sin(angle) + away * std::cos(angle)) + up) /
                     std::sqrt(x * x + y * y + 1);
  return std::isfinite(lit) ? 0.65 + 0.35 * std::clamp(lit, 0.0, 1.0) : 1;
}

/// Degrees from which it is looked down on: so steep that the underside is seldom seen below the
/// near edge.
constexpr double steep = 52;

/// gnuplot's scale of the view: what rises far at the far side would reach into the heading.
double view_scale(const Surface& surface, double factor, double view) {
  constexpr double usual = 1.5, highest = 0.45;  // above the middle of the box, in widths
  const double angle = view * std::numbers::pi / 180, down = steep * std::numbers::pi / 180;
  const double x = (surface.x_min + surface.x_max) / 2, y = (surface.y_min + surface.y_max) / 2;
  const double u = (surface.lowest + surface.highest) / 2;
  double top = highest * surface.width();
  for (const Triangle& triangle : surface.triangles)
    for (const Vertex& v : triangle)
      top = std::max(top,
                     ((v.y - y) * std::cos(angle) - (v.x - x) * std::sin(angle)) * std::cos(down) +
                         factor * (v.u - u) * std::sin(down));
  return usual * highest * surface.width() / top;
}

std::string membrane_data(const Surface& surface, double view, bool mesh) {
  const double factor = amplification(surface);
  const Shades shades = shades_of(surface);
  std::string text = "$membrane << EOD\n";
  // gnuplot has no triangles: each is a quadrilateral A B / C C.
  constexpr std::size_t most = 24000;
  for (const Triangle& triangle :
       mesh ? surface.triangles : refined(surface.triangles, surface.width() / 60, most)) {
    const double u = (triangle[0].u + triangle[1].u + triangle[2].u) / 3;
    const std::string shade = " " +
                              colour(shades.palette, (u - shades.range.low) / shades.range.size(),
                                     brightness(triangle, factor, view)) +
                              "\n";
    const auto line = [&](const Vertex& v) {
      text += number(v.x, 12) + " " + number(v.y, 12) + " " + number(factor * v.u, 6) + shade;
    };
    line(triangle[0]);
    line(triangle[1]);
    text += "\n";
    line(triangle[2]);
    line(triangle[2]);
    text += "\n\n";
  }
  return text + "EOD\n";
}

using Names = std::vector<std::pair<std::string, Vertex>>;

/// Inclusions, each at the middle of its first part, on the plus face, which it holds.
Names names_of(const results::Result& result, const results::Load& load, double factor) {
  Names names;
  for (std::size_t i = 0; i < load.traces.size(); ++i) {
    const results::Interface& interface = result.interfaces[i];
    const std::vector<std::int32_t>& of = interface.edges.inclusion;
    for (std::size_t first = 0, end = 0; first < of.size(); first = end) {
      for (end = first; end < of.size() && of[end] == of[first];) ++end;
      if (of[first] < 0) continue;
      const std::string& name = result.mesh.inclusions[static_cast<std::size_t>(of[first])];
      if (std::ranges::find(names, name, &Names::value_type::first) != names.end()) continue;
      const double middle = (interface.s[first] + interface.s[end]) / 2;
      const auto node = static_cast<std::size_t>(std::ranges::lower_bound(interface.s, middle) -
                                                 interface.s.begin());
      names.push_back(
          {name, {interface.x[node], interface.y[node], factor * load.traces[i].u_plus[node]}});
    }
  }
  return names;
}

/// A job with an accuracy made the mesh for its answer. Of more triangles edges could not be told
/// apart; of a coarsened surface they would be no edges of the mesh.
bool shows_mesh(const results::Result& result, const results::Load& load, const Surface& surface) {
  constexpr std::size_t most = 12000;
  return load.stages.size() != 0 && surface.triangles.size() == result.mesh.triangle_count() &&
         surface.triangles.size() <= most;
}

/// Of each triangle.
std::string border(bool mesh, Format format) {
  if (mesh) return "set pm3d border linewidth 0.2 linecolor rgb '#B0000000'\n";
  // Cairo blurs the edges of polygons, and what lies behind shines through; SVG draws them crisp.
  return format == Format::svg ? "set pm3d noborder\n" : "set pm3d border retrace linewidth 0.3\n";
}

/// More names would cover each other and the membrane.
constexpr std::size_t most_names = 6;

std::string membrane_panel(const Surface& surface, const results::Load& load, double view,
                           bool mesh, const Names& names, const std::string& length,
                           const Place& place, Format format) {
  const double factor = amplification(surface);
  const double low = factor * surface.lowest;
  const double high = factor * surface.highest;
  const double base = std::min(low, 0.0) - 0.02 * surface.width();
  const auto at = [&](double x, double y) {
    return "screen " + number(place.x + x * place.width) + ", screen " +
           number(place.y + y * place.height);
  };
  std::string text;
  // gnuplot centres the box, not what is drawn in it, which leaves room above, and not the labels
  // of its two near sides, which take room where they run away from the viewer.
  const double turned = std::fmod(view, 90) * std::numbers::pi / 180;
  const double aside = 0.1 * (std::cos(turned) - std::sin(turned)) * place.width;
  text +=
      "set origin " + number(place.x - aside) + "," + number(place.y + 0.07 * place.height) + "\n";
  text += "set size " + number(place.width) + "," + number(place.height) + "\n";
  text += "unset key\nset border 15 linewidth 0.7 linecolor rgb '#888888'\n";
  text += "unset xlabel\nunset ylabel\n";
  text += "set tics font ',7' textcolor rgb '#333333'\nunset ztics\n" + label_steps(surface, view);
  text += "set xrange [" + number(surface.x_min, 15) + ":" + number(surface.x_max, 15) + "]\n";
  text += "set yrange [" + number(surface.y_min, 15) + ":" + number(surface.y_max, 15) + "]\n";
  text += "set zrange [" + number(std::min(low, 0.0)) + ":" +
          number(std::max(high, low + 0.1 * surface.width())) + "]\n";
  text += "set xyplane at " + number(base) + "\n";
  text += "set view " + number(steep) + ", " + number(view) + ", " +
          number(view_scale(surface, factor, view), 3) + "\nset view equal xyz\n";
  const Scale scale({surface.lowest, surface.highest});
  const Shades shades = shades_of(surface);
  text += colour_bar(shades.palette, scale.drawn(shades.range));
  text += "set cbtics offset 0,0.3\nset pm3d depthorder\n" + border(mesh, format);
  text += "set colorbox user horizontal origin " + at(0.22, 0.105) + " size screen " +
          number(0.56 * place.width) + ", screen " + number(0.03 * place.height) + "\n";
  text += "set label 5 " + figures::quoted(scale.label("u", length)) + " at " + at(0.81, 0.12) +
          " left noenhanced\n";
  text += caption(membrane_heading(factor, load), place);
  // Not `set xlabel`: terminals keep different distances for it.
  const double middle_x = (surface.x_min + surface.x_max) / 2;
  const double middle_y = (surface.y_min + surface.y_max) / 2;
  // A label beside its numbers needs more room than one below them.
  const double angle = view * std::numbers::pi / 180;
  const double below_x = (0.29 + 0.07 * std::abs(std::sin(angle))) * surface.width();
  const double beside_y = (0.29 + 0.07 * std::abs(std::cos(angle))) * surface.width();
  // As gnuplot's axes, on the near sides.
  const double front = sees_low_y(view) ? surface.y_min - below_x : surface.y_max + below_x;
  const double side = view < 180 ? surface.x_max + beside_y : surface.x_min - beside_y;
  const auto axis_name = [&](const char* axis, double low_end, double high_end) {
    return figures::quoted(Scale({low_end, high_end}, surface.width()).label(axis, length));
  };
  text += space_label(3, axis_name("x", surface.x_min, surface.x_max), {middle_x, front, base});
  text += space_label(4, axis_name("y", surface.y_min, surface.y_max), {side, middle_y, base});
  if (names.size() <= most_names) {
    text += light_boxes;
    int tag = 10;
    for (const auto& [name, middle] : names)
      text += space_label(tag++, figures::quoted(name, 18), middle,
                          " offset 0,0.6 font ',7' textcolor " + black + " front boxed");
  }
  text +=
      "splot $membrane using 1:2:3:4 with pm3d fillcolor rgb variable linewidth 0.3 notitle, "
      "NaN with pm3d notitle";  // which alone has the colour bar
  return text + "\nunset label\n";
}

}  // namespace

double membrane_view(const results::Result& result) {
  constexpr double oblique = 28;
  double angle = 0;
  if (!result.interfaces.empty() && result.interfaces[0].node_count() > 1) {
    const results::Interface& interface = result.interfaces[0];
    angle = std::atan2(interface.y.back() - interface.y.front(),
                       interface.x.back() - interface.x.front()) *
            180 / std::numbers::pi;
  }
  return std::fmod(oblique + 360 - angle, 360);
}

Picture membrane_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface) {
  const double view = membrane_view(result);
  const bool mesh = shows_mesh(result, load, surface);
  const Names names = names_of(result, load, amplification(surface));
  return {
      membrane_data(surface, view, mesh),
      {result.title, load.name},
      [=, &surface, &load, length = result.units.label("L")](Format format, const Place& place) {
        return membrane_panel(surface, load, view, mesh, names, length, place, format);
      },
      narrow};
}

}  // namespace anticrack::figures
