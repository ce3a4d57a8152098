// SPDX-License-Identifier: GPL-3.0-or-later
//
// What pictures of a sweep consist of, cut down to what can be seen of it. For the sources of this
// folder only.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::figures {

/// What the rows are drawn over: the coefficient that varies where exactly one does; where two do,
/// on a circle around 0, their angle in degrees; else the numbers of the rows.
struct SweepAxis {
  enum class Parameter { row, coefficient, angle };

  std::string label;  ///< "row", "coefficient of shear [-]", "angle from pull to shear [°]"
  Parameter parameter = Parameter::row;
  std::vector<double> position;    ///< (rows)
  std::vector<std::size_t> order;  ///< rows by position, increasing

  /// Whether neighbours belong together, so that a curve may join them.
  bool joined() const noexcept { return parameter != Parameter::row; }
};

/// O(rows log rows).
SweepAxis sweep_axis(const results::Sweep& sweep);

struct CurvePoint {
  double x = 0;
  double y = 0;  ///< NaN where the row did not converge: a gap
};

/// A column of (rows, columns) over the axis, at most about twice `limit` points: of more rows the
/// least and the greatest of neighbours are kept, so that no extreme is lost. O(rows).
std::vector<CurvePoint> curve(const results::Sweep& sweep, const SweepAxis& axis,
                              const std::vector<double>& values, std::size_t column,
                              std::size_t columns, std::size_t limit);

/// A stretch of an interface, for some neighbouring rows.
struct ContactBox {
  double begin = 0, end = 0;  ///< along the interface
  double low = 0, high = 0;   ///< on the axis of the rows
  double closed = 0;          ///< part of these rows that are in contact there, 0 to 1
};

struct ContactMap {
  std::string position_label;  ///< "x [-]"
  std::string interface;       ///< its name, where there are several
  std::vector<ContactBox> boxes;
  bool shades = false;  ///< a box stands for several rows
};

/// Where the cracks of an interface are closed, row by row; at most `limit` strips of rows. No
/// boxes where the interface has no crack. O(rows contacts).
ContactMap contact_map(const results::Result& result, const SweepAxis& axis, std::size_t interface,
                       std::size_t limit);

}  // namespace anticrack::figures
