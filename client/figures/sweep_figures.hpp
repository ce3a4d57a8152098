// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pictures of a sweep, and what they consist of, reduced to what can be seen. A Picture refers to
// the arguments it was made of. For the sources of this folder only.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "figures/axes.hpp"
#include "figures/drawing.hpp"
#include "results/result.hpp"

namespace anticrack::figures {

/// The horizontal axis: the coefficient that varies if exactly one does; the angle in degrees if
/// two vary on a circle around 0; else the number of the row.
struct SweepAxis {
  enum class Parameter { row, coefficient, angle };

  std::string label;  ///< "row", "coefficient of shear", "angle from pull to shear [°]"
  Parameter parameter = Parameter::row;
  std::vector<double> position;    ///< (rows)
  std::vector<std::size_t> order;  ///< rows by increasing position

  /// Whether a curve may join neighbours.
  bool joined() const noexcept { return parameter != Parameter::row; }
};

/// O(rows log rows).
SweepAxis sweep_axis(const results::Sweep& sweep);

struct CurvePoint {
  double x = 0;
  double y = 0;  ///< NaN where the row did not converge: a gap
};

/// A column of (rows, columns) over the axis in at most about 2 `limit` points. Of more rows the
/// least and the greatest of neighbours are kept, so no extreme is lost. O(rows).
std::vector<CurvePoint> curve(const results::Sweep& sweep, const SweepAxis& axis,
                              const std::vector<double>& values, std::size_t column,
                              std::size_t columns, std::size_t limit);

/// A stretch of an interface, for some neighbouring rows.
struct ContactBox {
  double begin = 0, end = 0;  ///< along the interface
  double low = 0, high = 0;   ///< on the axis of the rows
  double closed = 0;          ///< part of these rows in contact there, 0 to 1
};

struct ContactMap {
  std::string position_label;  ///< "x [mm]"
  Scale labels;                ///< of that axis
  std::string interface;       ///< its name, if there are several
  std::vector<ContactBox> boxes;
  bool shades = false;  ///< a box stands for several rows
};

/// Where the cracks of an interface are closed, in at most `limit` strips of rows. No boxes without
/// a crack. O(rows contacts).
ContactMap contact_map(const results::Result& result, const SweepAxis& axis, std::size_t interface,
                       std::size_t limit);

/// A of every inclusion above, contact length below, over the axis.
Picture sweep_picture(const results::Result& result, const SweepAxis& axis);

/// Bx of every inclusion above, By below, over the axis.
Picture slope_picture(const results::Result& result, const SweepAxis& axis);

/// Where the cracks of one interface are closed, over the axis.
Picture contact_picture(const results::Result& result, const SweepAxis& axis,
                        const ContactMap& map);

/// Draws "sweep" and, where an inclusion tilted, "sweep-slope"; notes what is left out.
void draw_sweep(const results::Result& result, Drawing& drawing);

/// Draws "sweep-contact" of each of these interfaces that has cracks; of a sweep with rows that
/// converged.
void draw_contacts(const results::Result& result, const std::vector<std::size_t>& interfaces,
                   Drawing& drawing);

}  // namespace anticrack::figures
