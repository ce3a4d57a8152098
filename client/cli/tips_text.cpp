// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tips_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cli/text.hpp"
#include "results/entries.hpp"

namespace anticrack::cli {
namespace {

std::string words_of(const v1::Tip& tip) {
  std::string text = results::name_in(*v1::TipKind_descriptor(), tip.kind());
  std::ranges::replace(text, '_', ' ');
  return tip.closed() ? text + ", closed" : text;
}

std::string number_of(const v1::Tip& tip, const char* name) {
  const double value = results::number_in(tip, name);
  return std::isfinite(value) ? number(value, 5) : "-";
}

/// The spread of G, in per cent of it.
std::string spread_of(const v1::Tip& tip) {
  const double g = results::number_in(tip, "G"), spread = results::number_in(tip, "G_spread");
  return g > 0 ? number(100 * spread / g, 2) : "-";
}

}  // namespace

std::string tips_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all) {
  const auto unit = [&](const char* name) {
    return sanitise(results::unit_of(units, results::entry_of(*v1::Tip::descriptor(), name)->unit));
  };
  std::vector<std::vector<std::string>> rows{
      {"load", "x", "y", "tip", "exponent", "intensity", "K_III", "G", "spread of G"},
      {"", unit("x"), unit("y"), "", "", "", unit("K_III"), unit("G"), "%"}};
  std::set<std::string> reasons;
  for (const results::Load& load : loads) {
    if (!load.has_answer()) continue;
    for (const v1::Tip& tip : load.answer.tips()) {
      rows.push_back({sanitise(load.name()), number(tip.x(), 5), number(tip.y(), 5), words_of(tip),
                      number_of(tip, "exponent"), number_of(tip, "intensity"),
                      number_of(tip, "K_III"), number_of(tip, "G"), spread_of(tip)});
      if (!tip.reason().empty())
        reasons.insert(fmt::format("tip at {}, {}: {}\n", number(tip.x(), 5), number(tip.y(), 5),
                                   sanitise(tip.reason())));
    }
  }
  const std::size_t count = rows.size() - 2;
  if (count == 0) return "";
  if (count > few_rows && !all)
    return fmt::format("\nall {} rows of tips: anticrack show RESULT --tips\n", count);
  std::string text = "\n" + table(rows, {3});
  for (const std::string& reason : reasons) text += reason;
  return text;
}

}  // namespace anticrack::cli
