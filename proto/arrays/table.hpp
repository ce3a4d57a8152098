// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tables of arrays: for each one its name, shape, place in a struct and meaning, listed once for
// everything that reads, writes, checks or describes it.
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace anticrack::arrays {

/// A row of a table. Its `member` is a pointer to a member, or a function that returns one by
/// reference: std::invoke(row.member, record).
template <class Member>
struct Array {
  std::string_view name;
  std::string_view shape;  ///< "k" or "k,2"; a letter or word is an extent; empty: a single value
  Member member;
  std::string_view what;    ///< for people
  bool explained = false;   ///< files say `what`, too: the numbers do not explain themselves
  std::string_view unit{};  ///< for people; in F (force) and L (length) where the case names them
  bool optional = false;    ///< may be missing: the member then is empty, or its default
};

/// A row: a std::vector of numbers or texts, or with an empty shape a single one.
template <class Member>
constexpr Array<Member> array(std::string_view name, std::string_view shape, Member member,
                              std::string_view what, std::string_view unit = {}) {
  return {name, shape, member, what, false, unit};
}

/// The same with `explained`.
template <class Member>
constexpr Array<Member> explained(std::string_view name, std::string_view shape, Member member,
                                  std::string_view what, std::string_view unit = {}) {
  return {name, shape, member, what, true, unit};
}

/// A single value.
template <class Member>
constexpr Array<Member> scalar(std::string_view name, Member member, std::string_view what,
                               std::string_view unit = {}) {
  return {name, {}, member, what, false, unit};
}

/// The same row, of what may be missing.
template <class Member>
constexpr Array<Member> optional(Array<Member> row) {
  row.optional = true;
  return row;
}

/// A member of a member.
template <class Outer, class Inner>
constexpr auto within(Outer outer, Inner inner) {
  return [ outer, inner ](auto& record) -> auto& { return record.*outer.*inner; };
}

/// visit(row) for each row of one or more tables, in order.
template <class Visit, class... Tables>
void for_each(Visit&& visit, const Tables&... tables) {
  const auto walk = [&visit](const auto&... rows) { (visit(rows), ...); };
  (std::apply(walk, tables), ...);
}

/// Columns that a shape names by a word: their number depends on other arrays.
inline constexpr std::size_t named = static_cast<std::size_t>(-1);

/// The second extent of a shape, as "inclusions" of "rows,inclusions,2"; empty where it has one.
constexpr std::string_view second_of(std::string_view shape) {
  const std::size_t comma = shape.find(',');
  if (comma == std::string_view::npos) return {};
  const std::string_view rest = shape.substr(comma + 1);
  return rest.substr(0, rest.find(','));
}

/// Columns of a shape: 0 for one of one dimension, else their number, or `named`.
constexpr std::size_t columns_of(std::string_view shape) {
  const std::string_view second = second_of(shape);
  if (second.empty()) return 0;
  const char digit = second[0];  // more than one is not needed
  return digit >= '0' && digit <= '9' ? static_cast<std::size_t>(digit - '0') : named;
}

/// The third extent of a shape, a digit: 2 of "rows,inclusions,2"; 1 where it has none.
constexpr std::size_t depth_of(std::string_view shape) {
  const std::size_t comma = shape.rfind(',');
  if (comma == shape.find(',')) return 1;
  return static_cast<std::size_t>(shape[comma + 1] - '0');
}

/// What a row's member is in a struct.
template <class Record, class Member>
using MemberOf = std::remove_cvref_t<std::invoke_result_t<const Member&, Record&>>;

}  // namespace anticrack::arrays
