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
    for (const std::vector<double>* column : columns) text += number((*column)[i], 12) + " ";
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

double offset_of(const Range& range, double extent) {
  constexpr double far = 1e3;  // labels of two digits more than those of the range
  const double size = std::max(range.size(), extent);
  if (!(size > 0) || !(std::max(std::abs(range.low), std::abs(range.high)) > far * size)) return 0;
  const double round = std::pow(10.0, std::floor(std::log10(size)) + 2);
  return std::round((range.low + range.high) / 2 / round) * round;
}

std::string named_without(const std::string& name, double offset) {
  if (offset == 0) return name;
  return name + (offset > 0 ? " \xE2\x88\x92 " : " + ") + readable(std::abs(offset), 15);
}

std::string point_text(double x, double y, double size, int digits) {
  const auto text = [&](double value) {
    const double decades = std::log10(std::abs(value) / size);
    const int more = std::isfinite(decades) ? static_cast<int>(std::ceil(decades)) : 0;
    return readable(value, std::clamp(digits + more, digits, 15));
  };
  return "(" + text(x) + ", " + text(y) + ")";
}

Scale::Scale(const Range& range, double extent) {
  _offset = offset_of(range, extent);
  const double largest = std::max(std::abs(range.low - _offset), std::abs(range.high - _offset));
  if (!std::isfinite(largest) || largest == 0 || (largest >= 2e-3 && largest < 1e5)) return;
  _exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

Range Scale::drawn(const Range& range) const noexcept {
  const double factor = std::pow(10.0, -_exponent);
  return {(range.low - _offset) * factor, (range.high - _offset) * factor};
}

std::string Scale::text(double value) const {
  const double shown = (value - _offset) * std::pow(10.0, -_exponent);
  return readable(std::abs(shown) < 1e-9 ? 0 : shown, 6);
}

std::string Scale::column(int number) const {
  const std::string name = std::to_string(number);
  if (_exponent == 0 && _offset == 0) return name;
  const std::string value =
      _offset == 0 ? "$" + name : "($" + name + "-" + figures::number(_offset, 15) + ")";
  return "(" + value + "*1e" + std::to_string(-_exponent) + ")";
}

std::string Scale::label(const std::string& name, const std::string& unit) const {
  const std::string text = named_without(name, _offset);
  if (_exponent == 0) return results::labelled(text, unit);
  const std::string behind = unit.empty() ? "" : " " + unit;
  return results::labelled(text + (_offset == 0 ? "" : behind), power_of_ten(_exponent) + behind);
}

std::string tics(char axis, const Range& range, double step, const Scale& drawn) {
  const double low = range.low - 1e-9 * range.size(), high = range.high + 1e-9 * range.size();
  const std::string command = std::string("set ") + axis + "tics ";
  const auto first = [&] { return std::ceil(low / step); };
  if (first() * step <= high && drawn.plain())
    return command + number(first() * step) + ", " + number(step) + ", " + number(range.high);
  std::string marks;
  const auto mark = [&](double index) {
    marks +=
        (marks.empty() ? "('" : ", '") + drawn.text(index * step) + "' " + number(index * step, 15);
  };
  // Bounded, as there may be no number between those of a file.
  constexpr int most = 50;
  for (int k = 0; k < most && (first() + k) * step <= high; ++k) mark(first() + k);
  if (marks.empty() && high > low) {
    for (int k = 0; k < most && first() * step > high; ++k) step /= 10;
    mark(std::clamp(std::round((low + high) / 2 / step), first(),
                    std::max(first(), std::floor(high / step))));
  }
  return command + (marks.empty() ? "(" : marks) + ")";
}

std::string axis_range(char axis, const Range& range, int most, double step, const Scale& labels) {
  Range shown = range;
  if (!(shown.low <= shown.high)) shown = {0, 0};
  const double rounding = 1e-9 * std::max(std::abs(shown.low), std::abs(shown.high));
  if (shown.size() <= rounding) {
    const double middle = shown.low;
    const double half = middle == 0 ? 1 : 0.5 * std::abs(middle);
    shown = {middle - half, middle + half};
  }
  const double apart = step > 0 ? step : label_step(shown, most);
  return std::string("set ") + axis + "range [" + number(shown.low, 15) + ":" +
         number(shown.high, 15) + "]\n" +
         (labels.plain() && std::ceil(shown.low / apart) * apart <= shown.high
              ? std::string("set ") + axis + "tics " + number(apart)
              : tics(axis, shown, apart, labels)) +
         "\n";
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
