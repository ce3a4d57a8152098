// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>

#include "cli/case_error.hpp"

namespace anticrack::cli {
namespace {

struct Range {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};

class Selection {
 public:
  Selection(const std::string& text, std::uint64_t rows) : _text(text), _rows(rows) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw CaseError("--traces " + _text, problem);
  }

  /// The ranges sorted and without overlaps.
  std::vector<Range> ranges() const {
    if (_text == "none" || _rows == 0) return {};
    if (_text == "all") return {{0, _rows - 1}};
    std::vector<Range> ranges;
    for (std::size_t begin = 0; begin <= _text.size();) {
      const std::size_t comma = std::min(_text.find(',', begin), _text.size());
      ranges.push_back(range_of(std::string_view(_text).substr(begin, comma - begin)));
      begin = comma + 1;
    }
    std::ranges::sort(ranges, {}, &Range::first);
    std::vector<Range> merged;
    for (const Range& range : ranges)
      if (!merged.empty() && range.first <= merged.back().last)
        merged.back().last = std::max(merged.back().last, range.last);
      else
        merged.push_back(range);
    return merged;
  }

 private:
  std::uint64_t row_of(std::string_view part, std::string_view item) const {
    std::uint64_t row = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), row);
    if (end != part.data() + part.size() || error == std::errc::invalid_argument) {
      fail("\"" + std::string(item) +
           "\" is not a row; write all, none, or rows, for example 0,10,20-30");
    }
    if (error == std::errc::result_out_of_range || row >= _rows)
      fail(fmt::format("there is no row {}; rows are 0 to {}", part, _rows - 1));
    return row;
  }

  Range range_of(std::string_view item) const {
    const std::size_t dash = std::min(item.find('-'), item.size());
    const std::uint64_t first = row_of(item.substr(0, dash), item);
    const std::uint64_t last = dash < item.size() ? row_of(item.substr(dash + 1), item) : first;
    if (last < first) {
      fail(fmt::format("the range {} ends before it begins; write {}-{}", item, last, first));
    }
    return {first, last};
  }

  const std::string& _text;
  std::uint64_t _rows;
};

}  // namespace

std::vector<std::uint32_t> select_rows(const std::string& text, std::uint64_t rows,
                                       std::uint64_t most) {
  const Selection selection(text, rows);
  const std::vector<Range> ranges = selection.ranges();
  std::uint64_t count = 0;
  for (const Range& range : ranges) count += range.last - range.first + 1;
  if (count > most) {
    selection.fail(fmt::format(
        "these are {} rows, the server keeps the traces of {} at most; name fewer", count, most));
  }
  if (!ranges.empty() && ranges.back().last > std::numeric_limits<std::uint32_t>::max())
    selection.fail(fmt::format("row {} is too large to be named", ranges.back().last));
  std::vector<std::uint32_t> selected;
  selected.reserve(static_cast<std::size_t>(count));
  for (const Range& range : ranges)
    for (std::uint64_t row = range.first; row <= range.last; ++row)
      selected.push_back(static_cast<std::uint32_t>(row));
  return selected;
}

}  // namespace anticrack::cli
