// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "cli/text.hpp"
#include "words/nearest.hpp"

namespace anticrack::cli {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == std::string_view::npos) return {};
  text = text.substr(begin, text.find_last_not_of(blank) - begin + 1);
  const bool in_quotes = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return in_quotes ? text.substr(1, text.size() - 2) : text;
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  while (true) {
    const std::size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

/// A number in any locale. None unless the whole text is a number; infinity if it is too large.
std::optional<double> number_of(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || end != text.data() + text.size() || error == std::errc::invalid_argument)
    return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // A number that is too small counts as zero; its negative exponent tells it from a large one.
    const bool small = text.find("e-") != text.npos || text.find("E-") != text.npos;
    return small ? 0.0 : HUGE_VAL;
  }
  return value;
}

/// A field for messages: shortened, without control characters.
std::string shown_field(std::string_view value) {
  constexpr std::size_t longest = 40;
  std::string text(value.substr(0, longest));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }, '?');
  return "\"" + text + (value.size() > longest ? "..." : "") + "\"";
}

class Reader {
 public:
  Reader(std::string source, const std::vector<std::string>& loads)
      : _source(std::move(source)), _loads(loads), _columns(loads.size()) {
    std::iota(_columns.begin(), _columns.end(), std::size_t{0});
  }

  void line(std::string_view text, unsigned number) {
    _line = number;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (number == 1 && text.substr(0, byte_order_mark.size()) == byte_order_mark)
      text.remove_prefix(byte_order_mark.size());
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos || text[begin] == '#') return;
    const bool first = !std::exchange(_begun, true);
    if (first && text.find(';') != std::string_view::npos) _separator = ';';
    split_fields(text, _separator, _fields);
    if (first && is_header())
      take_header();
    else
      take_row();
  }

  std::vector<double> finish() {
    if (_values.empty()) {
      throw CaseError(_source, "there is no row; write a line of " +
                                   counted(_loads.size(), "coefficient") +
                                   " for each load case of the sweep");
    }
    return std::move(_values);
  }

 private:
  std::string at_line() const { return fmt::format("{}:{}", _source, _line); }

  [[noreturn]] void fail(const std::string& problem) const { throw CaseError(at_line(), problem); }
  [[noreturn]] void fail(std::size_t column, const std::string& problem) const {
    throw CaseError(fmt::format("{}: column {}", at_line(), column + 1), problem);
  }

  /// Whether the first line is a header: all its fields are names of loads (which may look like
  /// numbers), or none is a number.
  bool is_header() const {
    const auto is_load = [this](std::string_view field) {
      return std::find(_loads.begin(), _loads.end(), field) != _loads.end();
    };
    return std::all_of(_fields.begin(), _fields.end(), is_load) ||
           std::none_of(_fields.begin(), _fields.end(),
                        [this](std::string_view field) { return value_of(field).has_value(); });
  }

  /// The value of a field. If semicolons separate fields, a comma is a decimal point.
  std::optional<double> value_of(std::string_view field) const {
    if (_separator == ',') return number_of(field);
    const std::size_t comma = field.find(',');
    if (comma == std::string_view::npos) return number_of(field);
    if (field.find('.') != std::string_view::npos) return std::nullopt;
    std::string text(field);
    text[comma] = '.';
    return number_of(text);
  }

  /// Refuses a number with a decimal comma beside one with a decimal point, as one of the two
  /// separates thousands.
  void check_decimal_mark(std::size_t column) {
    if (_separator == ',') return;
    const std::string_view field = _fields[column];
    const std::size_t at = field.find_first_of(".,");
    if (at == std::string_view::npos) return;
    if (_decimal_mark == 0) {
      _decimal_mark = field[at];
      _mark_line = _line;
    }
    if (field[at] == _decimal_mark) return;
    fail(column,
         fmt::format("{}{}, line {} has decimal {}; write all numbers one way", shown_field(field),
                     field[at] == ',' ? " has a decimal comma" : " has a decimal point", _mark_line,
                     _decimal_mark == ',' ? "commas" : "points"));
  }

  void take_header() {
    const auto place = [this](std::size_t column) {
      return fmt::format("{}: column {}", at_line(), column + 1);
    };
    _columns = loads_of_columns({_fields.begin(), _fields.end()}, _loads, place);
    for (std::size_t load = 0; load < _loads.size(); ++load)
      if (std::ranges::count(_columns, load) == 0)
        fail("there is no column for load " + _loads[load] +
             "; add one (of zeros, where it takes no part), or take the load out of the case");
  }

  std::string cure_of(std::string_view field) const {
    if (_separator == ',' && field.find(';') != std::string_view::npos)
      return "the first line has no semicolons; write the same separator in every line";
    return "write one as 1.5 or -2e-3";
  }

  void take_row() {
    if (_fields.size() != _columns.size()) {
      fail(counted(_fields.size(), "value") + " in this line, the case has " +
           counted(_loads.size(), "load") + "; write one coefficient for each of " +
           fmt::format("{}", fmt::join(_loads, ", ")) + ", with " +
           (_separator == ';' ? "semicolons" : "commas") +
           " between (semicolons where the numbers have decimal commas)");
    }
    const std::size_t row = _values.size();
    _values.resize(row + _loads.size());
    for (std::size_t i = 0; i < _fields.size(); ++i) {
      const std::optional<double> value = value_of(_fields[i]);
      if (!value) fail(i, shown_field(_fields[i]) + " is not a number; " + cure_of(_fields[i]));
      check_decimal_mark(i);
      if (!std::isfinite(*value))
        fail(i, shown_field(_fields[i]) + " is not finite; write a finite number");
      _values[row + _columns[i]] = *value;
    }
  }

  std::string _source;
  const std::vector<std::string>& _loads;
  std::vector<std::size_t> _columns;  ///< load of each column of the text
  std::vector<std::string_view> _fields;
  std::vector<double> _values;
  unsigned _line = 0;
  char _separator = ',';    ///< for all lines: a semicolon if the first line has one
  char _decimal_mark = 0;   ///< for all numbers; 0: no number had one yet
  unsigned _mark_line = 0;  ///< line with the first one
  bool _begun = false;
};

}  // namespace

std::vector<std::size_t> loads_of_columns(const std::vector<std::string>& names,
                                          const std::vector<std::string>& loads,
                                          const std::function<std::string(std::size_t)>& place) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = std::ranges::find(loads, names[i]);
    if (found == loads.end()) {
      throw CaseError(place(i), shown_field(names[i]) + " is not a load of the case; " +
                                    words::suggestion(names[i], loads));
    }
    const auto load = static_cast<std::size_t>(found - loads.begin());
    if (std::ranges::count(columns, load) > 0)
      throw CaseError(place(i), "load " + *found + " is named twice; keep one of the two columns");
    columns.push_back(load);
  }
  return columns;
}

std::vector<double> parse_coefficients(std::istream& text, const std::string& source,
                                       const std::vector<std::string>& loads) {
  Reader reader(source, loads);
  std::string line;
  for (unsigned number = 1; std::getline(text, line); ++number) reader.line(line, number);
  if (text.bad()) throw CaseError(source, "cannot be read to its end; the disk reports an error");
  return reader.finish();
}

std::vector<double> read_coefficients(const std::filesystem::path& file,
                                      const std::vector<std::string>& loads) {
  std::ifstream text(file, std::ios::binary);
  if (std::filesystem::is_directory(file) || !text) {
    throw CaseError(file.string(),
                    "cannot be read; name a .csv file, or a dataset as FILE.h5:/PATH");
  }
  return parse_coefficients(text, file.string(), loads);
}

}  // namespace anticrack::cli
