// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/vertex_separator.hpp"

#include <algorithm>
#include <cstdlib>

#include "base/at.hpp"

namespace anticrack::ddm {
namespace {

constexpr std::int32_t none = -1;    // no path through this vertex
constexpr std::int32_t a_side = -2;  // the path begins or ends here

constexpr std::int32_t entered(std::int32_t vertex) { return 2 * vertex; }
constexpr std::int32_t left(std::int32_t vertex) { return 2 * vertex + 1; }
constexpr std::int32_t vertex_of(std::int32_t state) { return state / 2; }
constexpr bool is_left(std::int32_t state) { return state % 2 == 1; }

}  // namespace

/// Calls `reach` with the states that lead to `state`.
template <class Reach>
void VertexSeparator::each_before(const Band& band, std::int32_t state, const Reach& reach) const {
  const std::int32_t v = vertex_of(state), next = _next[at(v)];
  if (is_left(state)) {
    if (next != a_side) reach(entered(next == none ? v : next));
    return;
  }
  if (next != none) reach(left(v));
  for (std::int32_t e = band.begin[at(v)]; e < band.begin[at(v) + 1]; ++e)
    reach(left(band.neighbour[at(e)]));
}

/// Calls `reach` with the states that `state` leads to.
template <class Reach>
void VertexSeparator::each_after(const Band& band, std::int32_t state, const Reach& reach) const {
  const std::int32_t v = vertex_of(state), next = _next[at(v)];
  if (!is_left(state)) {
    if (next == none)
      reach(left(v));
    else if (_previous[at(v)] != a_side)
      reach(left(_previous[at(v)]));
    return;
  }
  if (next != none) reach(entered(v));
  for (std::int32_t e = band.begin[at(v)]; e < band.begin[at(v) + 1]; ++e)
    reach(entered(band.neighbour[at(e)]));
}

/// Breadth-first distances to the second side, up to the first side. Returns the length of the
/// shortest path, -1 if there is none.
std::int32_t VertexSeparator::find_levels(const Band& band) {
  _level.assign(2 * band.size(), -1);
  _open.clear();
  for (std::size_t v = 0; v < band.size(); ++v) {
    if (band.meets_second[v] != 0) {
      const std::int32_t state = left(static_cast<std::int32_t>(v));
      _level[at(state)] = 0;
      _open.push_back(state);
    }
  }
  std::int32_t last = -1;
  for (std::size_t i = 0; i < _open.size(); ++i) {
    const std::int32_t state = _open[i], level = _level[at(state)];
    if (last >= 0 && level >= last) break;
    if (!is_left(state) && band.meets_first[at(vertex_of(state))] != 0) {
      last = level;
      continue;
    }
    each_before(band, state, [&](std::int32_t before) {
      if (_level[at(before)] < 0) {
        _level[at(before)] = level + 1;
        _open.push_back(before);
      }
    });
  }
  return last;
}

/// A state one level below `state` that it leads to and that was not tried yet, or -1.
std::int32_t VertexSeparator::step(const Band& band, std::int32_t state) {
  const std::int32_t v = vertex_of(state), level = _level[at(state)] - 1;
  if (!is_left(state)) {
    const std::int32_t previous = _previous[at(v)];
    const std::int32_t only =
        _next[at(v)] == none ? left(v) : (previous >= 0 ? left(previous) : -1);
    return only >= 0 && _level[at(only)] == level ? only : -1;
  }
  if (_next[at(v)] != none && _level[at(entered(v))] == level) return entered(v);
  for (std::int32_t& e = _cursor[at(v)]; e < band.begin[at(v) + 1]; ++e) {
    const std::int32_t u = band.neighbour[at(e)];
    if (_level[at(entered(u))] == level) return entered(u);
  }
  return -1;
}

/// Depth-first search down the levels to the second side; dead ends lose their level.
bool VertexSeparator::find_way(const Band& band, std::int32_t from) {
  _way.assign(1, from);
  while (!_way.empty()) {
    const std::int32_t state = _way.back();
    if (_level[at(state)] == 0) return true;
    if (const std::int32_t next = step(band, state); next >= 0) {
      _way.push_back(next);
    } else {
      _level[at(state)] = -1;
      _way.pop_back();
    }
  }
  return false;
}

/// Augments the flow by `_way`, which may undo parts of other paths.
void VertexSeparator::push() {
  for (std::size_t i = 0; i < _way.size(); ++i) {
    const std::int32_t state = _way[i], v = vertex_of(state);
    _level[at(state)] = -1;
    if (is_left(state))
      _next[at(v)] = i + 1 < _way.size() ? vertex_of(_way[i + 1]) : a_side;
    else if (i > 0 && _way[i - 1] == left(v))
      _previous[at(v)] = _next[at(v)] = none;  // no path goes through it any more
    else
      _previous[at(v)] = i > 0 ? vertex_of(_way[i - 1]) : a_side;
  }
}

/// Assigns the parts: states with a level are those that `near` reaches without crossing the
/// separator. Returns how many more vertices the first part has than the second.
std::ptrdiff_t VertexSeparator::assign(Part near, std::vector<Part>& parts) const {
  const Part far = near == Part::first ? Part::second : Part::first;
  std::ptrdiff_t excess = 0;
  for (std::size_t v = 0; v < parts.size(); ++v) {
    const bool in = _level[2 * v] >= 0, out = _level[2 * v + 1] >= 0;
    const bool cut = near == Part::first ? in && !out : out && !in;
    parts[v] = cut ? Part::separator : (in || out ? near : far);
    excess += parts[v] == Part::first ? 1 : (parts[v] == Part::second ? -1 : 0);
  }
  return excess;
}

/// Sets the levels of the states that the first side leads to.
void VertexSeparator::search_from_first(const Band& band) {
  std::fill(_level.begin(), _level.end(), -1);
  _open.clear();
  const auto reach = [this](std::int32_t state) {
    if (_level[at(state)] < 0) {
      _level[at(state)] = 0;
      _open.push_back(state);
    }
  };
  for (std::size_t v = 0; v < band.size(); ++v)
    if (band.meets_first[v] != 0) reach(entered(static_cast<std::int32_t>(v)));
  for (std::size_t i = 0; i < _open.size(); ++i) each_after(band, _open[i], reach);
}

const std::vector<Part>& VertexSeparator::find(const Band& band, std::ptrdiff_t first,
                                               std::ptrdiff_t second) {
  const auto n = static_cast<std::int32_t>(band.size());
  _previous.assign(band.size(), none);
  _next.assign(band.size(), none);
  for (std::int32_t steps = find_levels(band); steps >= 0; steps = find_levels(band)) {
    _cursor.assign(band.begin.begin(), band.begin.end() - 1);
    for (std::int32_t v = 0; v < n; ++v)
      if (band.meets_first[at(v)] != 0 && _level[at(entered(v))] == steps &&
          find_way(band, entered(v)))
        push();
  }
  // The last search has given levels to all states that lead to the second side.
  _part.resize(band.size());
  const std::ptrdiff_t excess = first - second + assign(Part::second, _part);
  if (8 * std::abs(excess) > first + second + n) {  // the other separator may balance better
    search_from_first(band);
    _other.resize(band.size());
    if (std::abs(first - second + assign(Part::first, _other)) < std::abs(excess))
      _part.swap(_other);
  }
  return _part;
}

}  // namespace anticrack::ddm
