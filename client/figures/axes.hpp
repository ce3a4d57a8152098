// SPDX-License-Identifier: GPL-3.0-or-later
//
// What panels have in common: colours, margins, labels, ranges. For the sources of this folder
// only.
#pragma once

#include <string>

#include "figures/panels.hpp"

namespace anticrack::figures {

// Okabe & Ito; the curves differ in dash as well, for print without colour.
inline const std::string blue = "rgb '#0072B2'";
inline const std::string vermillion = "rgb '#D55E00'";
inline const std::string green = "rgb '#009E73'";
inline const std::string black = "rgb '#222222'";
inline const std::string contact_shade = "rgb '#C9E4F4'";

// The parts of an interface have one colour in all pictures; they differ in brightness, too.
inline const std::string bonded_colour = "rgb '#000000'";
inline const std::string delaminated_colour = "rgb '#E69F00'";
inline const std::string crack_colour = "rgb '#B04A8A'";

/// Where the axes stand, fractions of the place.
std::string margins(const Place& place, double left, double right, double bottom, double top);

/// The same with room for the labels of a vertical axis.
std::string margins(const Place& place, double bottom, double top);

/// Above the axes.
std::string caption(const std::string& text, const Place& place);

/// Label of the horizontal axis at a height of the place: terminals measure the distance `set
/// xlabel` keeps in characters of different sizes.
std::string below(const std::string& quoted_text, double height, const Place& place);

/// Label of the vertical axis, at the left of the place.
std::string beside(const std::string& quoted_text, const Place& place);

/// Legend at the foot of the place, in columns of `rows` entries.
std::string legend(int rows, const Place& place);

/// Commands: how axes, tics and grid look in all figures.
std::string axes();

struct Range {
  double low = 0;
  double high = 0;

  /// Below 0 while nothing is in it.
  double size() const noexcept { return high - low; }
  /// Takes the value in, if it is finite.
  void include(double value) noexcept;
};

/// Nothing is in it yet.
Range empty_range() noexcept;

/// A round distance of labels that leaves at most about `most` of them.
double label_step(const Range& range, int most = 6);

/// Values too small or too large to be written at an axis are drawn as multiples of a power of ten
/// that its label names.
class Scale {
 public:
  Scale() = default;
  /// Of data in this range; one that is written well as it is has the factor 1.
  explicit Scale(const Range& range);

  /// The range as drawn.
  Range drawn(const Range& range) const noexcept;
  /// A column of data as drawn, for `using`.
  std::string column(int number) const;
  /// "[-]", or "[10⁻⁶]".
  std::string unit() const;

 private:
  int _exponent = 0;
};

/// `set xrange` or `set yrange`, with labels `step` apart, 0: at a round distance that leaves at
/// most about `most` of them; of a range without extent, one around it.
std::string axis_range(char axis, const Range& range, int most = 6, double step = 0);

}  // namespace anticrack::figures
