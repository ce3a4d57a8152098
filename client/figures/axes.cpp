// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/axes.hpp"

#include <algorithm>
#include <cmath>

#include "figures/text.hpp"

namespace anticrack::figures {

std::string data_block(const std::string& name,
                       const std::vector<const std::vector<double>*>& columns) {
  std::string text = "$" + name + " << EOD\n";
  for (std::size_t i = 0; i < columns.at(0)->size(); ++i) {
    for (const std::vector<double>* column : columns) text += number((*column)[i]) + " ";
    text += "\n";
  }
  return text + "EOD\n";
}

std::string margins(const Place& place, double left, double right, double bottom, double top) {
  return "set lmargin at screen " + number(place.x + left * place.width) +
         "\nset rmargin at screen " + number(place.x + right * place.width) +
         "\nset bmargin at screen " + number(place.y + bottom * place.height) +
         "\nset tmargin at screen " + number(place.y + top * place.height) + "\n";
}

std::string margins(const Place& place, double bottom, double top) {
  return margins(place, 0.185, 0.96, bottom, top);
}

std::string caption(const std::string& text, const Place& place, double height) {
  const bool fits = length(text) <= 46;
  return "set label 2 " + quoted(text, 56) + (fits ? "" : " font ',7'") + " at screen " +
         number(place.x + 0.5 * place.width) + ", screen " +
         number(place.y + height * place.height) + " center noenhanced textcolor rgb '#222222'\n";
}

std::string below(const std::string& quoted_text, double height, const Place& place) {
  return "set label 3 " + quoted_text + " at graph 0.5, screen " +
         number(place.y + height * place.height) + " center noenhanced\n";
}

std::string beside(const std::string& quoted_text, const Place& place) {
  return "set label 4 " + quoted_text + " at screen " + number(place.x + 0.03 * place.width) +
         ", graph 0.5 center rotate by 90 noenhanced\n";
}

std::string legend(int rows, const Place& place) {
  return "set key at screen " + number(place.x + 0.54 * place.width) + ", screen " +
         number(place.y + 0.01 * place.height) + " center bottom vertical maxrows " +
         std::to_string(rows) +
         " Left reverse noenhanced samplen 2.5 width 1 height 0.3 font ',7'\n";
}

std::string axes() {
  return "set border 3 linewidth 0.7 linecolor rgb '#555555'\n"
         "set tics in nomirror offset 0,0 font ',7' textcolor rgb '#333333'\n"
         "set grid xtics ytics linewidth 0.5 linecolor rgb '#dddddd' dashtype solid\n";
}

void Range::include(double value) noexcept {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

Range empty_range() noexcept { return {HUGE_VAL, -HUGE_VAL}; }

double label_step(const Range& range, int most) {
  const double least = range.size() / most;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (least <= step * power * 1.05) return step * power;
  return 10 * power;
}

Scale::Scale(const Range& range) {
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  if (!std::isfinite(largest) || largest == 0 || (largest >= 2e-3 && largest < 1e5)) return;
  _exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

Range Scale::drawn(const Range& range) const noexcept {
  const double factor = std::pow(10.0, -_exponent);
  return {range.low * factor, range.high * factor};
}

std::string Scale::column(int number) const {
  const std::string name = std::to_string(number);
  return _exponent == 0 ? name : "($" + name + "*1e" + std::to_string(-_exponent) + ")";
}

std::string Scale::label(const std::string& name, const std::string& unit) const {
  const std::string power = _exponent == 0 ? "" : power_of_ten(_exponent);
  return results::labelled(name, power + (power.empty() || unit.empty() ? "" : " ") + unit);
}

std::string axis_range(char axis, const Range& range, int most, double step) {
  Range shown = range;
  if (!(shown.low <= shown.high)) shown = {0, 0};
  const double rounding = 1e-9 * std::max(std::abs(shown.low), std::abs(shown.high));
  if (shown.size() <= rounding) {
    const double middle = shown.low;
    const double half = middle == 0 ? 1 : 0.5 * std::abs(middle);
    shown = {middle - half, middle + half};
  }
  return std::string("set ") + axis + "range [" + number(shown.low) + ":" + number(shown.high) +
         "]\nset " + axis + "tics " + number(step > 0 ? step : label_step(shown, most)) + "\n";
}

std::string log_axis(char axis, const Range& range, bool labelled) {
  const double size = range.high / range.low;
  const double room = std::max(1.15, std::pow(size, 0.05));
  const Range shown{range.low / room, range.high * room};
  const double decades = std::log10(shown.high / shown.low);
  std::string marks;
  const auto mark = [&](double value, const std::string& label, bool major) {
    if (value < shown.low || value > shown.high) return;
    marks += (marks.empty() ? "'" : ", '") + (major && labelled ? label : "") + "' " +
             number(value) + (major ? "" : " 1");
  };
  // Decades, of which labels stand at even distances as on a plain axis, or at 1, 2 and 5.
  constexpr double fewest = 0.7, few = 2;
  if (decades <= fewest) {
    const double step = label_step(shown);
    for (double index = std::ceil(shown.low / step); index * step <= shown.high; ++index)
      mark(index * step, readable(index * step, 5), true);
  }
  const int every = std::max(1, static_cast<int>(std::ceil(decades / 6)));
  for (int power = static_cast<int>(std::floor(std::log10(shown.low)));
       decades > fewest && power <= std::log10(shown.high); ++power) {
    for (int leading = 1; leading < (every > 1 ? 2 : 10); ++leading) {
      const double value = leading * std::pow(10.0, power);
      mark(value, decades > few ? power_of_ten(power) : readable(value, 5),
           leading == 1 ? power % every == 0 : decades <= few && (leading == 2 || leading == 5));
    }
  }
  return std::string("set logscale ") + axis + "\nset " + axis + "range [" + number(shown.low) +
         ":" + number(shown.high) + "]\nset " + axis + "tics (" + marks + ")\n";
}

}  // namespace anticrack::figures
