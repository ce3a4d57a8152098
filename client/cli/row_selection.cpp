// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_input.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "cli/report.hpp"

namespace anticrack::cli {

std::vector<std::uint32_t> select_rows(const std::string& text, std::size_t rows) {
  const auto fail = [&text](const std::string& problem) {
    throw CaseError("--traces " + text, problem);
  };
  const auto row_of = [&](std::string_view part, std::string_view item) {
    std::size_t row = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), row);
    if (end != part.data() + part.size() || error == std::errc::invalid_argument)
      fail(fmt::format("\"{}\" is not a row; write all, none, or rows, for example 0,10,20-30",
                       item));
    if (error == std::errc::result_out_of_range || row >= rows)
      fail(fmt::format("there is no row {}; rows are 0 to {}", part, rows - 1));
    return row;
  };
  std::vector<bool> chosen(rows, text == "all");
  const bool listed = rows > 0 && text != "all" && text != "none";
  for (std::size_t begin = 0; listed && begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string_view item = std::string_view(text).substr(begin, comma - begin);
    const std::size_t dash = std::min(item.find('-'), item.size());
    const std::size_t first = row_of(item.substr(0, dash), item),
                      last = dash < item.size() ? row_of(item.substr(dash + 1), item) : first;
    if (last < first)
      fail(fmt::format("the range {} ends before it begins; write {}-{}", item, last, first));
    for (std::size_t row = first; row <= last; ++row) chosen[row] = true;
    begin = comma + 1;
  }
  std::vector<std::uint32_t> selected;
  for (std::size_t row = 0; row < rows; ++row)
    if (chosen[row]) selected.push_back(static_cast<std::uint32_t>(row));
  return selected;
}

}  // namespace anticrack::cli
