// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/linear_conditions.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"

namespace anticrack::ddm {
namespace {

/// A factor below this is the rounding error of levers that cancelled, which are at most 1.
constexpr double rounding = 1e-12;

void add(Terms& sum, const Terms& terms, double factor) {
  for (const Term& term : terms) {
    const auto place = std::lower_bound(sum.begin(), sum.end(), term.index,
                                        [](const Term& t, std::int32_t i) { return t.index < i; });
    if (place != sum.end() && place->index == term.index)
      place->factor += factor * term.factor;
    else
      sum.insert(place, {term.index, factor * term.factor});
  }
  std::erase_if(sum, [](const Term& term) { return std::abs(term.factor) <= rounding; });
}

void add(Row& sum, const Row& row, double factor) {
  add(sum.free, row.free, factor);
  add(sum.jumps, row.jumps, factor);
  add(sum.held, row.held, factor);
}

}  // namespace

LinearConditions::LinearConditions(std::size_t unknowns, std::size_t motions)
    : _motions(motions), _solved(unknowns) {}

Row LinearConditions::reduced(const Row& row) {
  Row result{{}, row.jumps, row.held};
  for (const Term& term : row.free) {
    std::optional<Row>& solved = _solved[at(term.index)];
    if (!solved) {
      add(result.free, {{term.index, 1}}, term.factor);
    } else {
      solved = reduced(*solved);
      add(result, *solved, term.factor);
    }
  }
  return result;
}

/// Solves condition = 0 for the last of its unknowns or, if all are motions, for the one with the
/// largest factor. Returns false if it has no unknowns.
bool LinearConditions::solve(Row condition) {
  if (condition.free.empty()) return false;
  auto pivot = std::prev(condition.free.end());
  if (at(pivot->index) < _motions) {
    pivot = std::max_element(
        condition.free.begin(), condition.free.end(),
        [](const Term& a, const Term& b) { return std::abs(a.factor) < std::abs(b.factor); });
  }
  const auto [unknown, factor] = *pivot;
  condition.free.erase(pivot);
  Row solved;
  add(solved, condition, -1 / factor);
  _solved[at(unknown)] = std::move(solved);
  return true;
}

void LinearConditions::follow(std::int32_t unknown, const Terms& of) {
  _solved[at(unknown)] = {of, {}, {}};
}

Terms LinearConditions::hold(const Terms& of, std::int32_t k) {
  Row condition = reduced({of, {}, {}});
  add(condition.held, {{k, 1}}, -1);
  return solve(condition) ? Terms{} : condition.held;
}

std::optional<Terms> LinearConditions::part(std::int32_t plus, std::int32_t minus, std::int32_t k) {
  Row condition = reduced({{{plus, 1}}, {}, {}});
  add(condition, reduced({{{minus, 1}}, {}, {}}), -1);
  if (condition.free.empty()) return condition.jumps;
  add(condition.jumps, {{k, 1}}, -1);
  solve(std::move(condition));
  return std::nullopt;
}

std::vector<Row> LinearConditions::rows(std::size_t& free) {
  std::vector<std::int32_t> number(_solved.size(), -1);
  std::int32_t count = 0;
  for (std::size_t i = 0; i < _solved.size(); ++i)
    if (!_solved[i]) number[i] = count++;
  free = at(count);
  std::vector<Row> result(_solved.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = reduced({{{static_cast<std::int32_t>(i), 1}}, {}, {}});
    for (Term& term : result[i].free) term.index = number[at(term.index)];
  }
  return result;
}

}  // namespace anticrack::ddm
