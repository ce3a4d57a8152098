// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/sweep_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "figures/axes.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Result;
using results::Sweep;

/// More points or strips than pixels show nothing new.
constexpr std::size_t point_limit = 1200;
constexpr std::size_t strip_limit = 400;

constexpr Place upper{0, 0.47, 1, 0.46};
constexpr Place lower{0, 0, 1, 0.46};

constexpr const char* open_shade = "rgb '#e4e4e4'";

struct CurveStyle {
  const char* colour;
  const char* dash;
};

/// Of curve i; those of a picture differ in colour and dash.
CurveStyle style_of(std::size_t i) {
  constexpr std::array<CurveStyle, 6> styles{{{"#0072B2", "solid"},
                                              {"#D55E00", "(8,4)"},
                                              {"#009E73", "(2,3)"},
                                              {"#CC79A7", "(12,3,3,3)"},
                                              {"#222222", "(4,4)"},
                                              {"#E69F00", "solid"}}};
  return styles[i % styles.size()];
}

std::string block(const std::string& name, const std::vector<CurvePoint>& points) {
  std::string text = "$" + name + " << EOD\n";
  for (const CurvePoint& point : points) {
    text += number(point.x) + " " + number(point.y) + "\n";
  }
  return text + "EOD\n";
}

std::string title_of(const Result& result) {
  return figures::quoted(result.title.empty() ? "sweep" : result.title, 90);
}

std::string counted_rows(const Sweep& sweep) {
  const results::SweepSummary counts = summary(sweep);
  std::string text = std::to_string(sweep.rows()) + (sweep.rows() == 1 ? " row" : " rows");
  if (counts.converged < sweep.rows()) {
    text += ", " + std::to_string(sweep.rows() - counts.converged) + " without an answer left out";
  }
  return text;
}

/// Rows next to each other on the axis of a coefficient differ by little: a curve joins them.
std::string drawn_as(const SweepAxis& axis, const CurveStyle& style) {
  constexpr std::size_t few = 60;
  const bool points = !axis.is_coefficient || axis.order.size() <= few;
  std::string text = axis.is_coefficient ? (points ? " with linespoints" : " with lines")
                                         : std::string(" with points");
  if (points)
    text += " pointtype 7 pointsize " + std::string(axis.order.size() <= few ? "0.8" : "0.4");
  if (axis.is_coefficient) text += " linewidth 2 dashtype " + std::string(style.dash);
  return text + " linecolor rgb '" + style.colour + "'";
}

std::string extent(const SweepAxis& axis) {
  if (axis.order.empty()) return "";
  const double low = axis.position[axis.order.front()];
  const double high = axis.position[axis.order.back()];
  return low < high ? "set xrange [" + number(low) + ":" + number(high) + "]\n" : std::string();
}

std::string panel(const SweepAxis& axis, const std::string& head, const std::string& label,
                  const std::string& plots, bool several, const Place& place) {
  std::string text = margins(place, 0.12, 0.96, 0.2, 0.9) + axes() + caption(head, place);
  text += extent(axis) + "set offsets 0, 0, graph " + (several ? "0.3" : "0.08") +
          ", graph 0.08\nset autoscale y\n";
  text += below(figures::quoted(axis.label), 0.045, place);
  text += "set ylabel " + figures::quoted(label) + " noenhanced\n";
  // Above the curves, where the offset leaves room for it.
  text += "set key top center horizontal maxrows 2 Left reverse noenhanced samplen 2.5\n";
  return text + "plot " + plots + "\nunset label\nset offsets\nset autoscale x\n";
}

}  // namespace

std::string sweep_script(const Result& result, const SweepAxis& axis,
                         const std::vector<Output>& outputs) {
  const Sweep& sweep = *result.sweep;
  const std::size_t inclusions = sweep.inclusions.size();
  std::string data = block("length", curve(sweep, axis, sweep.contact_length, 0, 1, point_limit));
  std::string displacements;
  for (std::size_t i = 0; i < inclusions; ++i) {
    const std::string name = "A" + std::to_string(i);
    data += block(name, curve(sweep, axis, sweep.displacement, i, inclusions, point_limit));
    displacements += (i == 0 ? "$" : ", $") + name + " using 1:2" + drawn_as(axis, style_of(i));
    displacements += inclusions == 1 ? std::string(" notitle")
                                     : " title " + figures::quoted(sweep.inclusions[i], 30);
  }
  const std::string lengths = "$length using 1:2" + drawn_as(axis, style_of(0)) + " notitle";
  return script(
      data, title_of(result),
      [&](Format) {
        std::string contact = panel(axis, "length in contact", "contact length [-]", lengths, false,
                                    inclusions == 0 ? Place{0, 0, 1, 0.93} : lower);
        if (inclusions == 0) return contact;
        return panel(axis,
                     "displacement A of the inclusion" + std::string(inclusions > 1 ? "s" : "") +
                         ",  " + counted_rows(sweep),
                     "A [-]", displacements, inclusions > 1, upper) +
               contact;
      },
      single, outputs);
}

std::string contact_script(const Result& result, const SweepAxis& axis, const ContactMap& map,
                           const std::vector<Output>& outputs) {
  std::string data = "$contact << EOD\n";
  double begin = HUGE_VAL, end = -HUGE_VAL, low = HUGE_VAL, high = -HUGE_VAL;
  for (const ContactBox& box : map.boxes) {
    const double left = std::min(box.begin, box.end);
    const double right = std::max(box.begin, box.end);
    begin = std::min(begin, left);
    end = std::max(end, right);
    low = std::min(low, box.low);
    high = std::max(high, box.high);
    for (const double value :
         {(left + right) / 2, (box.low + box.high) / 2, left, right, box.low, box.high}) {
      data += number(value) + " ";
    }
    data += number(box.closed) + "\n";
  }
  data += "EOD\n";
  const Place place{0, 0, 1, 0.93};
  const std::string where = map.interface.empty() ? std::string("the crack") : map.interface;
  return script(
      data, title_of(result),
      [&](Format) {
        std::string text = margins(place, 0.12, 0.96, 0.2, 0.925) + axes();
        text += caption("where " + where + " is closed,  " + counted_rows(*result.sweep), place);
        text += "set xrange [" + number(begin) + ":" + number(end) + "]\n";
        text += "set yrange [" + number(low) + ":" + number(high) + "]\n";
        text += below(figures::quoted(map.position_label), 0.115, place);
        text += "set ylabel " + figures::quoted(axis.label) + " noenhanced\n";
        text += "unset grid\nunset colorbox\nset palette defined (0 '#e4e4e4', 1 '#0072B2')\n";
        text += "set cbrange [0:1]\n";
        text += "set key at screen " + number(place.x + 0.54 * place.width) + ", screen " +
                number(place.y + 0.01 * place.height) +
                " center bottom vertical maxrows 1 Left reverse noenhanced samplen 2.5\n";
        text +=
            "plot $contact using 1:2:3:4:5:6:7 with boxxyerror fillstyle solid 1 border "
            "linewidth 0.3 linecolor palette notitle";  // the border hides the seams of Cairo
        text += std::string(", keyentry with boxes fillstyle solid 1 noborder linecolor ") +
                open_shade + " title 'open'";
        text += ", keyentry with boxes fillstyle solid 1 noborder linecolor " + blue +
                (map.shades ? " title 'closed (pale: in some rows)'" : " title 'closed'");
        return text + "\nunset label\n";
      },
      single, outputs);
}

void draw_sweep(const Result& result, Drawing& drawing) {
  const SweepAxis axis = sweep_axis(*result.sweep);
  if (summary(*result.sweep).converged == 0) {
    drawing.drawn.notes.push_back("no row of the sweep converged: nothing to draw of it");
    return;
  }
  drawing.draw("sweep", [&](const auto& outputs) { return sweep_script(result, axis, outputs); });
  for (std::size_t i = 0; i < result.interfaces.size(); ++i) {
    const ContactMap map = contact_map(result, axis, i, strip_limit);
    if (map.boxes.empty()) continue;
    const std::string stem =
        i == 0 ? std::string("sweep-contact") : "sweep-contact-" + std::to_string(i + 1);
    drawing.draw(stem,
                 [&](const auto& outputs) { return contact_script(result, axis, map, outputs); });
  }
}

}  // namespace anticrack::figures
