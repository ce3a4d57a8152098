// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <type_traits>
#include <variant>

#include "cli/text.hpp"
#include "results/result.hpp"

namespace anticrack::cli {
namespace {

constexpr int few_rows = 16;  // more are shown when they are asked for

std::string words_of(const v1::Tip& tip) {
  std::string text = results::name_in(*v1::TipKind_descriptor(), tip.kind());
  std::ranges::replace(text, '_', ' ');
  return tip.closed() ? text + ", closed" : text;
}

/// The spread of G, in per cent of it.
std::string spread_of(const v1::Tip& tip) {
  const double g = results::number_in(tip, "G"), spread = results::number_in(tip, "G_spread");
  return g > 0 ? number(100 * spread / g, 2) : "-";
}

/// Whether the row begins or ends something: it is the first or last, or the fronts run from there
/// or to there, or another front leads.
bool is_turn(const v1::LoadCaseAnswer& answer, int row) {
  if (row == 0 || row + 1 == answer.growth_size()) return true;
  const v1::GrowthRow &before = answer.growth(row - 1), &here = answer.growth(row),
                      &after = answer.growth(row + 1);
  return here.stable() != before.stable() || here.stable() != after.stable() ||
         here.interface() != before.interface();
}

using Rows = std::vector<std::vector<std::string>>;

/// Adds the heads of columns: names and units.
void add_heads(const google::protobuf::Descriptor& type, std::initializer_list<const char*> names,
               const v1::Units& units, Rows& rows) {
  for (const char* const name : names) {
    rows[0].emplace_back(name);
    rows[1].push_back(results::unit_of(units, results::entry_of(type, name)->unit));
  }
}

}  // namespace

std::string text_of(const results::Value& value) {
  return std::visit(
      [](const auto& one) -> std::string {
        if constexpr (std::is_same_v<std::decay_t<decltype(one)>, std::string>)
          return one;
        else if constexpr (std::is_floating_point_v<std::decay_t<decltype(one)>>)
          return number(one);
        else
          return std::to_string(one);
      },
      value);
}

std::string list_table(const results::Result& result, const char* name) {
  const auto& list = *v1::LoadCaseAnswer::descriptor()->FindFieldByName(name);
  const std::vector<results::Entry>& columns = results::entries_of(*list.message_type());
  Rows rows{{"load"}, {""}};
  std::vector<std::size_t> left;
  for (const results::Entry& column : columns) {
    const bool text = column.type == results::ValueType::text;
    if (text) left.push_back(rows[0].size());
    rows[0].push_back(column.name);
    rows[1].push_back(text ? "" : results::unit_of(result.units, column.unit));
  }
  for (const results::Load& load : result.loads) {
    if (!load.has_answer()) continue;
    for (const auto* item : results::items_of(load.answer, list)) {
      auto& row = rows.emplace_back(1, load.name());
      for (const results::Entry& column : columns)
        row.push_back(text_of(results::get(*item, column)));
    }
  }
  return rows.size() == 2 ? std::string("no ") + name + "\n" : table(rows, left);
}

std::string tips_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all) {
  Rows rows{{"load"}, {""}};
  add_heads(*v1::Tip::descriptor(), {"x", "y"}, units, rows);
  rows[0].insert(rows[0].end(), {"tip", "exponent", "intensity"});
  rows[1].insert(rows[1].end(), {"", "", ""});
  add_heads(*v1::Tip::descriptor(), {"K_III", "G"}, units, rows);
  rows[0].emplace_back("spread of G");
  rows[1].emplace_back("%");
  std::set<std::string> reasons;
  for (const results::Load& load : loads) {
    if (!load.has_answer()) continue;
    for (const v1::Tip& tip : load.answer.tips()) {
      const auto told = [&tip](const char* name) {
        return number(results::number_in(tip, name), 5);
      };
      rows.push_back({load.name(), told("x"), told("y"), words_of(tip), told("exponent"),
                      told("intensity"), told("K_III"), told("G"), spread_of(tip)});
      if (!tip.reason().empty())
        reasons.insert(
            fmt::format("tip at {}, {}: {}\n", told("x"), told("y"), sanitise(tip.reason())));
      if (tip.release_factor() > 0)
        reasons.insert(
            fmt::format("{}, tip at {}, {}: a crack ahead of it would start however small the load "
                        "is, at first "
                        "with the length l0 = ({}/Gc)^{}\n",
                        sanitise(load.name()), told("x"), told("y"), told("release_factor"),
                        number(1 / (1 - 2 * tip.exponent()), 5)));
    }
  }
  const std::size_t count = rows.size() - 2;
  if (count == 0) return "";
  if (count > few_rows && !all)
    return fmt::format("\nall {} rows of tips: anticrack show RESULT --tips\n", count);
  std::string text = "\n" + table(std::move(rows), {3});
  for (const std::string& reason : reasons) text += reason;
  return text;
}

std::string growth_table(const std::vector<results::Load>& loads, const v1::Units& units,
                         bool all) {
  struct Table {
    std::initializer_list<const char*> numbers;
    Rows rows{{"load case", "row", "front"}, {"", "", ""}};
    void add(const results::Load& load, int number_of_row) {
      const v1::GrowthRow& row = load.answer.growth(number_of_row);
      auto& cells = rows.emplace_back(std::vector{
          load.name(), std::to_string(number_of_row),
          row.front() < 0 ? "all closed" : fmt::format("{} {}", row.front(), row.interface())});
      for (const char* const name : numbers)
        cells.push_back(number(results::number_in(row, name), 5));
    }
  };
  Table mesh{{"position", "load", "displacement", "G1", "Gc", "contact_length"}},
      own{{"position", "load", "load_lower", "load_upper", "G1", "G1_final", "G1_lower",
           "G1_upper"}};
  for (Table* one : {&mesh, &own}) {
    add_heads(*v1::GrowthRow::descriptor(), one->numbers, units, one->rows);
    for (std::string& head : one->rows[0]) std::ranges::replace(head, '_', ' ');
  }
  mesh.rows[0].emplace_back("stable");
  mesh.rows[1].emplace_back("");
  std::string notes;
  bool left_out = false;
  for (const results::Load& load : loads) {
    const v1::LoadCaseAnswer& answer = load.answer;
    for (int i = 0; i < answer.growth_size(); ++i) {
      const v1::GrowthRow& row = answer.growth(i);
      if (row.has_g1_final() || row.has_energy_lower()) own.add(load, i);
      if (!all && answer.growth_size() > few_rows && !is_turn(answer, i)) {
        left_out = true;
        continue;
      }
      mesh.add(load, i);
      mesh.rows.back().emplace_back(row.stable() ? "yes" : "no");
    }
    for (const std::string& note : answer.growth_notes())
      notes += sanitise(load.name()) + ": " + sanitise(note) + "\n";
  }
  if (mesh.rows.size() == 2) return "";
  std::string text = "\n" + table(std::move(mesh.rows), {2, 9});
  if (left_out) text += "all rows: anticrack show RESULT --growth\n";
  if (own.rows.size() > 2)
    text += "\non meshes of their own, with bounds of the means to the next\n" +
            table(std::move(own.rows), {2}) + "\n";
  return text + notes;
}

std::string stages_table(const results::Load& load) {
  if (load.stages.empty()) return "";
  const bool of_a = std::ranges::any_of(load.stages, [](const v1::Stage& stage) {
    return stage.answers(0).has_displacement_error();
  });
  Rows rows{{"stage", "triangles", "energy", "error of u"}, {"", "-", "-", "%"}};
  if (of_a) {
    rows[0].emplace_back("error of A");
    rows[1].emplace_back("%");
  }
  rows[0].emplace_back("time");
  rows[1].emplace_back("s");
  for (std::size_t i = 0; i < load.stages.size(); ++i) {
    const v1::Stage& stage = load.stages[i];
    const v1::StageAnswer& answer = stage.answers(0);
    const auto per_cent_of = [&answer](const char* name) {
      return number(100 * results::number_in(answer, name), 2);
    };
    auto& row = rows.emplace_back(std::vector{
        std::to_string(i + 1), std::to_string(stage.triangles()),
        answer.has_energy_lower()
            ? results::interval(answer.energy(), answer.energy_lower(), answer.energy_upper())
            : number(answer.energy()),
        per_cent_of("error_bound_relative")});
    if (of_a) row.push_back(per_cent_of("displacement_error"));
    row.push_back(seconds(stage.seconds()));
  }
  return "\n" + sanitise(load.name()) + ", stage by stage:\n" + table(rows);
}

}  // namespace anticrack::cli
