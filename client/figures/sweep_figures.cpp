// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/sweep_figures.hpp"

#include <algorithm>
#include <map>

#include "figures/axes.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Result;
using results::Sweep;

/// More points or strips than pixels show nothing new.
constexpr std::size_t point_limit = 1200;
constexpr std::size_t strip_limit = 400;

constexpr const char* open_shade = "'#e4e4e4'";
constexpr const char* closed_shade = "'#0072B2'";

/// As a data block; extends `heights` by its values.
std::string curve_block(const std::string& name, const std::vector<CurvePoint>& points,
                        Range& heights) {
  std::string text = "$" + name + " << EOD\n";
  for (const CurvePoint& point : points) {
    text += number(point.x) + " " + number(point.y) + "\n";
    heights.include(point.y);
  }
  return text + "EOD\n";
}

Title sweep_title(const Result& result) {
  return {result.title.empty() ? "sweep" : result.title, ""};
}

std::string counted_rows(const Sweep& sweep) {
  const results::SweepSummary counts = summary(sweep);
  std::string text = std::to_string(sweep.rows()) + (sweep.rows() == 1 ? " row" : " rows");
  if (counts.converged < sweep.rows())
    text += ", " + std::to_string(sweep.rows() - counts.converged) + " without an answer left out";
  return text;
}

/// On the axis of a parameter neighbouring rows differ little: a curve joins them.
std::string drawn_as(const SweepAxis& axis, const CurveStyle& style) {
  constexpr std::size_t few = 60;
  const bool points = !axis.joined() || axis.order.size() <= few;
  std::string text =
      axis.joined() ? (points ? " with linespoints" : " with lines") : std::string(" with points");
  if (points)
    text += " pointtype 7 pointsize " + std::string(axis.order.size() <= few ? "0.4" : "0.2");
  if (axis.joined()) text += " linewidth 1.5 dashtype " + std::string(style.dash);
  return text + " linecolor rgb '" + style.colour + "'";
}

/// Of the rows; half a row around a single one.
Range extent(const SweepAxis& axis) {
  if (axis.order.empty()) return {0, 1};
  const double low = axis.position[axis.order.front()];
  const double high = axis.position[axis.order.back()];
  return low < high ? Range{low, high} : Range{low - 0.5, low + 0.5};
}

/// Between labels of the axis, at most six of them: rows have whole numbers, a turn has quarters.
double step_of(const SweepAxis& axis) {
  constexpr int most = 6;
  const double round = label_step(extent(axis), most);
  if (axis.parameter == SweepAxis::Parameter::row) return std::max(1.0, round);
  if (axis.parameter == SweepAxis::Parameter::angle) {
    for (const double step : {5.0, 15.0, 30.0, 45.0, 90.0})
      if (extent(axis).size() <= most * step && extent(axis).size() > step) return step;
  }
  return round;
}

/// With some room around the curves.
Range with_room(Range heights) {
  const double room = 0.06 * heights.size();
  return {heights.low - room, heights.high + room};
}

std::string axis_label(const SweepAxis& axis) {
  return figures::quoted(Scale(extent(axis)).label(axis.label, ""));
}

std::string panel(const SweepAxis& axis, const std::string& label, const Range& heights,
                  const std::string& plots, const Place& place) {
  return axis_range('x', extent(axis), 6, step_of(axis), Scale(extent(axis))) +
         axis_range('y', Scale(heights).drawn(heights), 8) + beside(figures::quoted(label), place) +
         "plot " + plots + "\nunset label\n";
}

/// Entries of the legend; what is beyond is drawn alike and counted.
constexpr std::size_t named = 6;

/// A number of every inclusion over the axis.
struct Curves {
  std::string name;  ///< of the number; that of its data blocks goes on with the inclusion's index
  std::string unit;  ///< of the number
  std::string blocks;  ///< the data
  Range heights = empty_range();
  std::vector<std::string> bounds{};  ///< data blocks beside those of the numbers: "lower", "upper"
};

/// Of column `part` of `parts` that `values` has for each inclusion.
Curves curves_of(const Sweep& sweep, const SweepAxis& axis, const std::string& name,
                 const std::string& unit, const std::vector<double>& values, std::size_t part,
                 std::size_t parts) {
  Curves curves{name, unit, {}};
  const std::size_t inclusions = sweep.inclusions.size();
  for (std::size_t i = 0; i < inclusions; ++i) {
    curves.blocks +=
        curve_block(name + std::to_string(i),
                    curve(sweep, axis, values, i * parts + part, inclusions * parts, point_limit),
                    curves.heights);
  }
  return curves;
}

/// A over the axis; with bounds where neighbouring rows are joined.
Curves displacements_of(const Sweep& sweep, const SweepAxis& axis, const std::string& unit) {
  Curves all = curves_of(sweep, axis, "A", unit, sweep.displacement, 0, 1);
  if (sweep.displacement_lower.empty() || !axis.joined()) return all;
  const auto add = [&](const char* name, const std::vector<double>& values) {
    const Curves bound = curves_of(sweep, axis, name, unit, values, 0, 1);
    all.blocks += bound.blocks;
    all.heights.include(bound.heights.low);
    all.heights.include(bound.heights.high);
    all.bounds.emplace_back(name);
  };
  add("lower", sweep.displacement_lower);
  add("upper", sweep.displacement_upper);
  return all;
}

/// The entries of the legend, to go on a plot.
std::string legend_of(const SweepAxis& axis, const std::vector<std::string>& inclusions) {
  std::string keys;
  if (inclusions.size() == 1) return keys;
  for (std::size_t i = 0; i < std::min(named, inclusions.size()); ++i) {
    keys += ", keyentry" + drawn_as(axis, curve_styles.at(i)) + " title " +
            figures::quoted(inclusions[i], 18);
  }
  if (inclusions.size() > named) {
    keys += ", keyentry with lines linecolor rgb '#bbbbbb' title '" +
            std::to_string(inclusions.size() - named) + " more'";
  }
  return keys;
}

std::string panel(const SweepAxis& axis, const Curves& curves, std::size_t inclusions,
                  const std::string& keys, const Place& place) {
  const Range heights = with_room(curves.heights);
  const Scale scale(heights);
  std::string plots;
  for (std::size_t i = inclusions; i-- > 0;) {
    const CurveStyle style = i < named ? curve_styles.at(i) : CurveStyle{"#bbbbbb", "solid"};
    plots += (plots.empty() ? "$" : ", $") + curves.name + std::to_string(i) +
             " using 1:" + scale.column(2) + drawn_as(axis, style) + " notitle";
    for (const std::string& bound : curves.bounds)
      plots += ", $" + bound + std::to_string(i) + " using 1:" + scale.column(2) +
               " with lines linewidth 0.5 linecolor rgb '" + style.colour + "' notitle";
  }
  return panel(axis, scale.label(curves.name, curves.unit), heights, plots + keys, place);
}

/// One panel above the other, over one axis; the legend of the upper one in between.
std::string stacked(const Sweep& sweep, const SweepAxis& axis, const std::string& upper,
                    const std::string& lower, const Place& place, const std::string& note = {}) {
  const bool legend = sweep.inclusions.size() > 1;
  std::string text = margins(place, legend ? 0.6 : 0.545, 0.935) + axes();
  text += "set format x ''\n" + caption(counted_rows(sweep) + note, place);
  text += "set key at screen " + number(place.x + 0.54 * place.width) + ", screen " +
          number(place.y + 0.59 * place.height) +
          " center top horizontal maxrows 3 Left reverse noenhanced samplen 2.5 font ',7'\n";
  text += upper + margins(place, 0.11, legend ? 0.475 : 0.5);
  return text + "set format x\nunset key\n" + below(axis_label(axis), 0.04, place) + axes() + lower;
}

}  // namespace

Picture sweep_picture(const Result& result, const SweepAxis& axis) {
  const Sweep& sweep = *result.sweep;
  const std::size_t inclusions = sweep.inclusions.size();
  Range lengths{0, 0};
  const std::string data =
      curve_block("length", curve(sweep, axis, sweep.contact_length, 0, 1, point_limit), lengths);
  const std::string length = result.units.label("L");
  const Curves displacements = displacements_of(sweep, axis, length);
  if (lengths.high == 0) lengths.high = 1;
  lengths = with_room(lengths);
  const Scale of_lengths(lengths);

  return {data + displacements.blocks, sweep_title(result),
          [=, &sweep, &axis](Format, const Place& place) {
            const std::string contact =
                panel(axis, of_lengths.label("contact length", length), lengths,
                      "$length using 1:" + of_lengths.column(2) + drawn_as(axis, curve_styles[0]) +
                          " notitle",
                      place);
            if (inclusions == 0) {
              return margins(place, 0.16, 0.905) + below(axis_label(axis), 0.04, place) + axes() +
                     caption(counted_rows(sweep), place) + contact;
            }
            const std::string keys = legend_of(axis, sweep.inclusions);
            return stacked(sweep, axis, panel(axis, displacements, inclusions, keys, place),
                           contact, place, displacements.bounds.empty() ? "" : "; thin: bounds");
          },
          inclusions == 0 ? narrow : tall};
}

Picture slope_picture(const Result& result, const SweepAxis& axis) {
  const Sweep& sweep = *result.sweep;
  const Curves along_x = curves_of(sweep, axis, "Bx", "", sweep.slope, 0, 2);
  const Curves along_y = curves_of(sweep, axis, "By", "", sweep.slope, 1, 2);
  return {along_x.blocks + along_y.blocks, sweep_title(result),
          [=, &sweep, &axis](Format, const Place& place) {
            const std::size_t inclusions = sweep.inclusions.size();
            const std::string keys = legend_of(axis, sweep.inclusions);
            return stacked(sweep, axis, panel(axis, along_x, inclusions, keys, place),
                           panel(axis, along_y, inclusions, "", place), place);
          },
          tall};
}

Picture contact_picture(const Result& result, const SweepAxis& axis, const ContactMap& map) {
  std::string data = "$contact << EOD\n";
  Range along = empty_range();
  Range rows = empty_range();
  // Boxes reach under those of the rows above, which are drawn over them: no seams in between.
  std::map<double, double> top;
  for (const ContactBox& box : map.boxes) top[box.low] = box.high;
  for (const ContactBox& box : map.boxes) {
    const double left = std::min(box.begin, box.end);
    const double right = std::max(box.begin, box.end);
    for (const double position : {left, right}) along.include(position);
    for (const double row : {box.low, box.high}) rows.include(row);
    const auto above = top.find(box.high);
    const double high = above == top.end() ? box.high : above->second;
    for (const double value :
         {(left + right) / 2, (box.low + high) / 2, left, right, box.low, high})
      data += number(value) + " ";
    data += number(box.closed) + "\n";
  }
  data += "EOD\n";
  const std::string where = map.interface.empty() ? std::string("the crack") : map.interface;
  return {
      data, sweep_title(result),
      [=, &result, &axis, &map](Format, const Place& place) {
        std::string text = margins(place, 0.25, 0.905) + axes();
        text += caption("where " + where + " is closed,  " + counted_rows(*result.sweep), place);
        text += axis_range('x', along, 6, 0, map.labels) +
                axis_range('y', rows, 6, step_of(axis), Scale(extent(axis)));
        text += below(figures::quoted(map.position_label), 0.115, place);
        text += beside(axis_label(axis), place);
        text += "unset grid\nset tics out\nunset colorbox\n";
        text += std::string("set palette defined (0 ") + open_shade + ", 1 " + closed_shade + ")\n";
        text += "set cbrange [0:1]\n" + legend(map.shades ? 2 : 1, place);
        text +=
            "plot $contact using 1:2:3:4:5:6:7 with boxxyerror fillstyle solid 1 noborder "
            "linecolor palette notitle";
        const auto key = [&](const char* colour, const char* name) {
          return std::string(", keyentry with boxes fillstyle solid 1 noborder linecolor rgb ") +
                 colour + " title '" + name + "'";
        };
        text += key(open_shade, "open");
        text += key(closed_shade, map.shades ? "closed (pale: in some rows)" : "closed");
        return text + "\nunset label\n";
      },
      narrow};
}

void draw_sweep(const Result& result, Drawing& drawing) {
  const SweepAxis axis = sweep_axis(*result.sweep);
  const results::SweepSummary counts = summary(*result.sweep);
  if (counts.converged == 0) {
    drawing.drawn.notes.push_back("no row of the sweep converged: nothing to draw of it");
    return;
  }
  if (!axis.joined() && !result.sweep->displacement_lower.empty())
    drawing.drawn.notes.push_back(
        "the sweep is drawn row by row, without bounds: its coefficients are not of one parameter; "
        "--csv has the bounds");
  drawing.draw("sweep", sweep_picture(result, axis));
  if (counts.tilted()) drawing.draw("sweep-slope", slope_picture(result, axis));
}

void draw_contacts(const Result& result, const std::vector<std::size_t>& interfaces,
                   Drawing& drawing) {
  const SweepAxis axis = sweep_axis(*result.sweep);
  for (const std::size_t i : interfaces) {
    const ContactMap map = contact_map(result, axis, i, strip_limit);
    if (map.boxes.empty()) continue;
    const std::string stem =
        i == 0 ? std::string("sweep-contact") : "sweep-contact-" + std::to_string(i + 1);
    drawing.draw(stem, contact_picture(result, axis, map));
  }
}

}  // namespace anticrack::figures
