// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shared by panels: colours, data, margins, labels, ranges. For the sources of this folder only.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "figures/canvas.hpp"

namespace anticrack::figures {

// Okabe & Ito; curves also differ in dash, for print without colour.
inline const std::string blue = "rgb '#0072B2'";
inline const std::string vermillion = "rgb '#D55E00'";
inline const std::string green = "rgb '#009E73'";
inline const std::string black = "rgb '#222222'";
inline const std::string contact_shade = "rgb '#C9E4F4'";

// Parts of an interface, the same in all pictures; they also differ in brightness.
inline const std::string bonded_colour = "rgb '#000000'";
inline const std::string delaminated_colour = "rgb '#E69F00'";
inline const std::string crack_colour = "rgb '#B04A8A'";
inline const std::string free_colour = "rgb '#8CD17D'";

struct CurveStyle {
  const char* colour;
  const char* dash;
};

/// Those of a picture differ in colour and dash.
inline constexpr std::array<CurveStyle, 8> curve_styles{{{"#0072B2", "solid"},
                                                         {"#D55E00", "(8,4)"},
                                                         {"#009E73", "(2,3)"},
                                                         {"#CC79A7", "(12,3,3,3)"},
                                                         {"#222222", "(4,4)"},
                                                         {"#E69F00", "solid"},
                                                         {"#56B4E9", "(8,4)"},
                                                         {"#8C6D31", "(2,3)"}}};

/// Columns of one length as a block of data.
std::string data_block(const std::string& name,
                       const std::vector<const std::vector<double>*>& columns);

/// Position of the axes, fractions of the place.
std::string margins(const Place& place, double left, double right, double bottom, double top);

/// The same with room for the labels of a vertical axis.
std::string margins(const Place& place, double bottom, double top);

/// Above the axes, at a height of the place.
std::string caption(const std::string& text, const Place& place, double height = 0.955);

/// Label of the horizontal axis at a height of the place: the distance of `set xlabel` differs
/// between terminals.
std::string below(const std::string& quoted_text, double height, const Place& place);

/// Label of the vertical axis, at the left of the place.
std::string beside(const std::string& quoted_text, const Place& place);

/// Legend at the bottom of the place, in columns of `rows` entries.
std::string legend(int rows, const Place& place);

/// The ground of labels that are `boxed`: they are read on any colour, and it shines through.
inline const std::string light_boxes =
    "set style textbox opaque margins 0.3,0.3 fillcolor rgb '#44FFFFFF' noborder\n";

/// Commands for axes, tics and grid in all figures.
std::string axes();

struct Range {
  double low = 0;
  double high = 0;

  /// Negative if empty.
  double size() const noexcept { return high - low; }
  /// Extends the range by a finite value.
  void include(double value) noexcept;
};

/// Without any value.
Range empty_range() noexcept;

/// A round distance for at most about `most` labels.
double label_step(const Range& range, int most = 6);

/// What labels of an axis leave out, so that they are short: a round number where the values are
/// far from 0 against their range or, where it is longer, the `extent` of all that is drawn to one
/// scale; else 0.
double offset_of(const Range& range, double extent = 0);

/// "x − 6000000", the name of an axis whose labels leave the offset out.
std::string named_without(const std::string& name, double offset);

/// "(0.5, 1)", a point with the digits that tell it from others of a line or sheet of this size.
std::string point_text(double x, double y, double size, int digits);

/// Draws values too small or too large for an axis as multiples of a power of ten, and those far
/// from 0 against their range without their offset; the label names both.
class Scale {
 public:
  Scale() = default;
  /// For data in this range, of an axis that is drawn to one scale with others up to this extent;
  /// the factor is 1 and the offset 0 where possible.
  explicit Scale(const Range& range, double extent = 0);

  /// Whether values are drawn as they are.
  bool plain() const noexcept { return _exponent == 0 && _offset == 0; }
  /// Of a label.
  std::string text(double value) const;

  /// The range as drawn.
  Range drawn(const Range& range) const noexcept;
  /// A column of data as drawn, for `using`.
  std::string column(int number) const;
  /// "u [10⁻⁶ mm]", with what there is of it in brackets.
  std::string label(const std::string& name, const std::string& unit) const;

 private:
  int _exponent = 0;
  double _offset = 0;
};

/// `set xtics` or `set ytics` at the multiples of `step` in the range, or at the roundest number
/// where none is; the labels are as drawn.
std::string tics(char axis, const Range& range, double step, const Scale& drawn);

/// `set xrange` or `set yrange` with labels `step` apart, 0: a round distance for at most about
/// `most` labels; data that is not drawn to the scale itself has its labels. A range without extent
/// is widened.
std::string axis_range(char axis, const Range& range, int most = 6, double step = 0,
                       const Scale& labels = Scale());

/// The same with a log scale, for positive values, with some room around them and at least two
/// labels; `labelled` or with marks alone.
std::string log_axis(char axis, const Range& range, bool labelled = true);

}  // namespace anticrack::figures
