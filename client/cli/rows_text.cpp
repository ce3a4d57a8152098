// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/rows_text.hpp"

#include <google/protobuf/message.h>

#include <type_traits>
#include <variant>
#include <vector>

#include "cli/text.hpp"
#include "results/entries.hpp"

namespace anticrack::cli {

std::string text_of(const results::Value& value) {
  return std::visit(
      [](const auto& one) -> std::string {
        if constexpr (std::is_same_v<std::decay_t<decltype(one)>, std::string>)
          return sanitise(one);
        else if constexpr (std::is_floating_point_v<std::decay_t<decltype(one)>>)
          return number(one);
        else
          return std::to_string(one);
      },
      value);
}

std::string rows_table(const results::Result& result, const char* name) {
  const auto& list = *v1::LoadCaseAnswer::descriptor()->FindFieldByName(name);
  const std::vector<results::Entry>& columns = results::entries_of(*list.message_type());
  std::vector<std::vector<std::string>> rows{{"load"}, {""}};
  std::vector<std::size_t> left;
  for (const results::Entry& column : columns) {
    const bool text = column.type == results::ValueType::text;
    if (text) left.push_back(rows[0].size());
    rows[0].push_back(column.name);
    rows[1].push_back(text ? "" : sanitise(results::unit_of(result.units, column.unit)));
  }
  for (const results::Load& load : result.loads) {
    const auto& fields = *load.answer.GetReflection();
    for (int i = 0; load.has_answer() && i < fields.FieldSize(load.answer, &list); ++i) {
      auto& row = rows.emplace_back(1, sanitise(load.name()));
      for (const results::Entry& column : columns)
        row.push_back(
            text_of(results::get(fields.GetRepeatedMessage(load.answer, &list, i), column)));
    }
  }
  return rows.size() == 2 ? std::string("no ") + name + "\n" : table(rows, left);
}

}  // namespace anticrack::cli
