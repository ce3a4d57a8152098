// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "figures/axes.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

/// viridis: for u of one sign.
const std::string sequential =
    "set palette defined (0 '#440154', 1 '#482878', 2 '#3e4a89', 3 '#31688e', 4 '#26828e', "
    "5 '#1f9e89', 6 '#35b779', 7 '#6ece58', 8 '#b5de2b', 9 '#fde725')\n";

/// Blue to red through light grey: for u of both signs, zero in the middle.
const std::string diverging =
    "set palette defined (0 '#1b4f8f', 1 '#4a90c8', 2 '#a6cbe3', 3 '#dedede', 4 '#f4b698', "
    "5 '#d6604d', 6 '#97162b')\n";

std::string colours(const Surface& surface, const Scale& scale) {
  const double largest = surface.largest();
  std::string palette = sequential;
  double low = surface.lowest;
  double high = surface.highest;
  if (largest == 0) {
    low = -1;
    high = 1;
  } else if (std::min(-low, high) > 0.05 * largest) {
    palette = diverging;
    low = -largest;
    high = largest;
  }
  const Range drawn = scale.drawn({low, high});
  return palette + "set cbrange [" + number(drawn.low) + ":" + number(drawn.high) +
         "]\nset cbtics " + number(label_step(drawn, 4)) +
         " offset 0,0.3 font ',7' textcolor rgb '#333333'\n";
}

std::string membrane_heading(double factor, const results::Load& load) {
  std::string text = factor == 1 ? std::string("deformed membrane, u to scale")
                                 : "deformed membrane, u amplified \xC3\x97" + readable(factor);
  if (load.status == results::Status::not_converged) text += ",  not converged";
  return text;
}

std::string space_label(int tag, const std::string& text, double x, double y, double z) {
  return "set label " + std::to_string(tag) + " '" + text + "' at first " + number(x) + ", first " +
         number(y) + ", first " + number(z) + " center noenhanced\n";
}

/// A short side has no room for as many labels.
std::string label_steps(const Surface& surface) {
  const double least = label_step({0, surface.width()}, 6);
  const auto step = [&](double low, double high) {
    return number(std::max(least, label_step({low, high}, 4)));
  };
  return "set xtics " + step(surface.x_min, surface.x_max) + " nomirror offset 0,-0.3\nset ytics " +
         step(surface.y_min, surface.y_max) + " nomirror offset 0.3,-0.2\n";
}

std::string membrane_data(const Surface& surface) {
  const double factor = amplification(surface);
  std::string text = "$membrane << EOD\n";
  const auto line = [&](const Vertex& v) {
    text += number(v.x) + " " + number(v.y) + " " + number(factor * v.u, 6) + " " + number(v.u, 6) +
            "\n";
  };
  // gnuplot has no triangles: each is a quadrilateral A B / C C.
  for (const Triangle& triangle : surface.triangles) {
    line(triangle[0]);
    line(triangle[1]);
    text += "\n";
    line(triangle[2]);
    line(triangle[2]);
    text += "\n\n";
  }
  return text + "EOD\n";
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

std::string membrane_panel(const Surface& surface, const results::Load& load, double view,
                           bool mesh, const Place& place, Format format) {
  const double factor = amplification(surface);
  const double low = factor * surface.lowest;
  const double high = factor * surface.highest;
  const double base = std::min(low, 0.0) - 0.02 * surface.width();
  const auto at = [&](double x, double y) {
    return "screen " + number(place.x + x * place.width) + ", screen " +
           number(place.y + y * place.height);
  };
  std::string text;
  // gnuplot centres the box, not what is drawn in it, which leaves room above.
  text += "set origin " + number(place.x) + "," + number(place.y + 0.06 * place.height) + "\n";
  text += "set size " + number(place.width) + "," + number(place.height) + "\n";
  text += "unset key\nset border 15 linewidth 0.7 linecolor rgb '#888888'\n";
  text += "unset xlabel\nunset ylabel\n";
  text += "set tics font ',7' textcolor rgb '#333333'\nunset ztics\n" + label_steps(surface);
  text += "set xrange [" + number(surface.x_min) + ":" + number(surface.x_max) + "]\n";
  text += "set yrange [" + number(surface.y_min) + ":" + number(surface.y_max) + "]\n";
  text += "set zrange [" + number(std::min(low, 0.0)) + ":" +
          number(std::max(high, low + 0.1 * surface.width())) + "]\n";
  text += "set xyplane at " + number(base) + "\n";
  text += "set view 58, " + number(view) + ", 1.5\nset view equal xyz\n";
  const Scale scale({surface.lowest, surface.highest});
  text += colours(surface, scale);
  text += "set pm3d depthorder corners2color mean lighting primary 0.35 specular 0.08\n";
  text += border(mesh, format);
  text += "set colorbox user horizontal origin " + at(0.22, 0.105) + " size screen " +
          number(0.56 * place.width) + ", screen " + number(0.03 * place.height) + "\n";
  text += "set label 5 'u " + scale.unit() + "' at " + at(0.81, 0.12) + " left noenhanced\n";
  text += caption(membrane_heading(factor, load), place);
  // Not `set xlabel`: terminals keep different distances for it.
  const double middle_x = (surface.x_min + surface.x_max) / 2;
  const double middle_y = (surface.y_min + surface.y_max) / 2;
  const double away = 0.33 * surface.width();
  text += space_label(3, "x [-]", middle_x, surface.y_min - away, base);
  text += space_label(4, "y [-]", surface.x_max + away, middle_y, base);
  text += "splot $membrane using 1:2:3:" + scale.column(4) + " with pm3d notitle\n";
  text += "unset label\n";
  return text;
}

}  // namespace

double membrane_view(const results::Result& result) {
  constexpr double oblique = 28;
  double angle = 0;
  if (!result.interfaces.empty() && result.interfaces[0].node_count() > 1) {
    const results::Interface& interface = result.interfaces[0];
    angle = std::atan2(interface.y.back() - interface.y.front(),
                       interface.x.back() - interface.x.front()) *
            180 / std::acos(-1.0);
  }
  return std::fmod(oblique + 360 - angle, 360);
}

Picture membrane_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface) {
  return {membrane_data(surface),
          {result.title, load.name},
          [&, mesh = shows_mesh(result, load, surface)](Format format, const Place& place) {
            return membrane_panel(surface, load, membrane_view(result), mesh, place, format);
          },
          narrow};
}

Picture combined_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface) {
  const Picture left = membrane_picture(result, load, surface);
  const Picture right = traces_picture(result, load, 0);
  return {left.data + right.data, left.title,
          [left = left.plots, right = right.plots](Format format, const Place& place) {
            const auto [left_half, right_half] = halves(place);
            return left(format, left_half) + right(format, right_half);
          },
          page};
}

}  // namespace anticrack::figures
