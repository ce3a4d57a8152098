// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/sweep_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "figures/profile.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Sweep;

bool converged(const Sweep& sweep, std::size_t row) {
  return sweep.status[row] == results::Status::converged;
}

/// The columns of the coefficients that are not constant.
std::vector<std::size_t> varying_columns(const Sweep& sweep) {
  std::vector<std::size_t> found;
  if (sweep.coefficients.empty()) return found;
  const std::size_t columns = sweep.loads.size();
  for (std::size_t j = 0; j < columns; ++j) {
    bool varies = false;
    for (std::size_t row = 1; row < sweep.rows() && !varies; ++row)
      varies = sweep.coefficients[row * columns + j] != sweep.coefficients[j];
    if (varies) found.push_back(j);
  }
  return found;
}

/// Degrees from the first of two columns to the second, of rows that lie on a circle around 0; each
/// less than half a turn from the row before if that makes a turn in all, else from -180 to 180.
/// Empty where they do not.
std::vector<double> angles(const Sweep& sweep, std::size_t first, std::size_t second) {
  constexpr double turn = 360;
  constexpr double rounding = 1e-6;  // of coefficients that were written with six digits
  const auto at = [&](std::size_t row, std::size_t column) {
    return sweep.coefficients[row * sweep.loads.size() + column];
  };
  const double radius = std::hypot(at(0, first), at(0, second));
  std::vector<double> plain, continued;
  for (std::size_t row = 0; row < sweep.rows(); ++row) {
    const double x = at(row, first), y = at(row, second);
    if (!(std::abs(std::hypot(x, y) - radius) <= rounding * radius)) return {};
    const double angle = std::atan2(y, x) * turn / 2 / std::numbers::pi;
    plain.push_back(angle);
    const double before = continued.empty() ? angle : continued.back();
    continued.push_back(angle + turn * std::round((before - angle) / turn));
  }
  const auto [least, greatest] = std::minmax_element(continued.begin(), continued.end());
  return *greatest - *least <= turn * (1 + rounding) ? continued : plain;
}

/// First and last entry of strip `index` of `count` strips over `size` entries.
std::pair<std::size_t, std::size_t> strip(std::size_t index, std::size_t count, std::size_t size) {
  return {index * size / count, (index + 1) * size / count};
}

/// A node of a crack: its column of Sweep::contact, and the part of the axis it stands for.
struct Cell {
  std::size_t node = 0;
  std::size_t column = 0;
  double begin = 0;
  double end = 0;
};

std::vector<Cell> cells_of(const Sweep& sweep, const std::vector<double>& position,
                           std::size_t interface) {
  std::vector<Cell> cells;
  for (std::size_t c = 0; c < sweep.contacts(); ++c) {
    if (static_cast<std::size_t>(sweep.contact_nodes[2 * c]) != interface) continue;
    const auto node = static_cast<std::size_t>(sweep.contact_nodes[2 * c + 1]);
    const double at = position[node];
    const double before = node == 0 ? at : (position[node - 1] + at) / 2;
    const double after = node + 1 == position.size() ? at : (at + position[node + 1]) / 2;
    cells.push_back({node, c, before, after});
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.node < b.node; });
  return cells;
}

/// Part of the rows that are closed at each cell, in steps that can be told apart; empty where no
/// row converged.
std::vector<double> closed_parts(const Sweep& sweep, const std::vector<Cell>& cells,
                                 const std::vector<std::size_t>& rows) {
  constexpr double shades = 8;
  std::vector<double> parts(cells.size(), 0);
  double count = 0;
  for (const std::size_t row : rows) {
    if (!converged(sweep, row)) continue;
    ++count;
    const std::uint8_t* contact = sweep.contact.data() + row * sweep.contacts();
    for (std::size_t i = 0; i < cells.size(); ++i) parts[i] += contact[cells[i].column];
  }
  if (count == 0) return {};
  for (double& part : parts) part = std::ceil(shades * part / count) / shades;
  return parts;
}

/// Neighbours of one shade become one box.
void add_boxes(const std::vector<Cell>& cells, const std::vector<double>& parts, double low,
               double high, std::vector<ContactBox>& boxes) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool goes_on =
        i > 0 && cells[i].node == cells[i - 1].node + 1 && parts[i] == parts[i - 1];
    if (goes_on)
      boxes.back().end = cells[i].end;
    else
      boxes.push_back({cells[i].begin, cells[i].end, low, high, parts[i]});
  }
}

}  // namespace

SweepAxis sweep_axis(const Sweep& sweep) {
  using Parameter = SweepAxis::Parameter;
  SweepAxis axis{"row", Parameter::row, std::vector<double>(sweep.rows()), {}};
  const std::vector<std::size_t> varying = varying_columns(sweep);
  const auto name = [&](std::size_t i, std::size_t room) {
    return shortened(sweep.loads[varying[i]], room);
  };
  std::iota(axis.position.begin(), axis.position.end(), 0.0);
  if (varying.size() == 1) {
    axis.label = "coefficient of " + name(0, 20);
    axis.parameter = Parameter::coefficient;
    for (std::size_t row = 0; row < sweep.rows(); ++row)
      axis.position[row] = sweep.coefficients[row * sweep.loads.size() + varying[0]];
  } else if (varying.size() == 2) {
    std::vector<double> degrees = angles(sweep, varying[0], varying[1]);
    if (!degrees.empty()) {
      axis.label = "angle from " + name(0, 10) + " to " + name(1, 10) + " [°]";
      axis.parameter = Parameter::angle;
      axis.position = std::move(degrees);
    }
  }
  axis.order.resize(sweep.rows());
  std::iota(axis.order.begin(), axis.order.end(), std::size_t{0});
  std::stable_sort(axis.order.begin(), axis.order.end(), [&](std::size_t a, std::size_t b) {
    return axis.position[a] < axis.position[b];
  });
  return axis;
}

std::vector<CurvePoint> curve(const Sweep& sweep, const SweepAxis& axis,
                              const std::vector<double>& values, std::size_t column,
                              std::size_t columns, std::size_t limit) {
  constexpr double gap = std::numeric_limits<double>::quiet_NaN();
  const auto point = [&](std::size_t row) {
    return CurvePoint{axis.position[row],
                      converged(sweep, row) ? values[row * columns + column] : gap};
  };
  const std::size_t rows = axis.order.size();
  const std::size_t strips = std::min(rows, limit);
  std::vector<CurvePoint> points;
  for (std::size_t i = 0; i < strips; ++i) {
    const auto [first, last] = strip(i, strips, rows);
    CurvePoint least{axis.position[axis.order[first]], gap};
    CurvePoint greatest = least;
    for (std::size_t k = first; k < last; ++k) {
      const CurvePoint next = point(axis.order[k]);
      if (std::isnan(least.y) || next.y < least.y) least = next;
      if (std::isnan(greatest.y) || next.y > greatest.y) greatest = next;
    }
    if (greatest.x < least.x) std::swap(least, greatest);
    points.push_back(least);
    if (last - first > 1) points.push_back(greatest);
  }
  return points;
}

ContactMap contact_map(const results::Result& result, const SweepAxis& axis, std::size_t interface,
                       std::size_t limit) {
  const Sweep& sweep = *result.sweep;
  results::Trace open;
  open.contact.assign(result.interfaces[interface].node_count(), 0);
  const Profile along = profile(result, interface, open);
  ContactMap map;
  map.position_label = along.axis;
  map.labels = along.labels;
  map.interface = along.name;
  const std::vector<Cell> cells = cells_of(sweep, along.position, interface);
  if (cells.empty()) return map;

  const std::size_t rows = axis.order.size();
  const std::size_t strips = std::min(rows, limit);
  map.shades = rows > strips;
  // A row reaches half-way to its neighbours.
  const auto border = [&](std::size_t k) {
    const auto at = [&](std::size_t i) { return axis.position[axis.order[i]]; };
    if (rows == 1) return at(0) + (k == 0 ? -0.5 : 0.5);
    if (k == 0) return at(0) - (at(1) - at(0)) / 2;
    if (k == rows) return at(rows - 1) + (at(rows - 1) - at(rows - 2)) / 2;
    return (at(k - 1) + at(k)) / 2;
  };
  for (std::size_t i = 0; i < strips; ++i) {
    const auto [first, last] = strip(i, strips, rows);
    const std::vector<std::size_t> those(axis.order.begin() + static_cast<std::ptrdiff_t>(first),
                                         axis.order.begin() + static_cast<std::ptrdiff_t>(last));
    add_boxes(cells, closed_parts(sweep, cells, those), border(first), border(last), map.boxes);
  }
  return map;
}

}  // namespace anticrack::figures
