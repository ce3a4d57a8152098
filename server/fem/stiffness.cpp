// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/stiffness.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stop/stop.hpp"

namespace anticrack::fem {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr const char* assembling = "assembling the stiffness of a mesh";

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

struct Entry {
  double value;
  std::int32_t row;
};

/// Each pair of nodes is kept once, in one of the columns
///   j < free:  rows >= j of K_FF,
///   j >= free: rows of K_FD, then rows >= j of K_DD.
struct Place {
  std::int32_t row, column;
};

Place place_in(std::int32_t a, std::int32_t b, std::int32_t free) {
  const std::int32_t low = std::min(a, b), high = std::max(a, b);
  return low < free && high >= free ? Place{low, high} : Place{high, low};
}

/// The columns, with an entry for each triangle before merging; diagonals are kept apart.
class Columns {
 public:
  Columns(const Triangulation& part, const Tension& tension, std::int32_t free)
      : _end(part.node_count() + 1, 0), _diagonal(part.node_count(), 0.0) {
    const std::vector<std::int32_t>& node = part.triangles;
    for (std::size_t t = 0; t < node.size(); t += 3) {
      stop::look_at_turn<stop::quick>(t / 3, assembling);
      for (std::size_t a = 0; a < 3; ++a)
        ++_end[at(place_in(node[t + a], node[t + (a + 1) % 3], free).column) + 1];
    }
    for (std::size_t j = 1; j < _end.size(); ++j) _end[j] += _end[j - 1];
    _entries.resize(node.size());
    for (std::size_t t = 0; t < node.size(); t += 3) {
      stop::look_at_turn<stop::quick>(t / 3, assembling);
      add(part, &node[t], tension.isotropic(t / 3), free);
    }
    // _end[j] has moved from where column j begins to where it ends.
    std::int32_t begin = 0;
    for (std::size_t j = 0; j < _diagonal.size(); ++j) {
      stop::look_at_turn<stop::quick>(j, assembling);
      begin = merge(j, begin);
    }
  }

  /// Columns first..last-1 with their rows from..to-1; `diagonals`: each begins with its diagonal.
  Sparse block(std::int32_t first, std::int32_t last, std::int32_t from, std::int32_t to,
               bool diagonals) const {
    Sparse result(to - from, last - first);
    std::int32_t* end = result.outerIndexPtr();
    for (std::int32_t j = first; j < last; ++j) {
      const auto [low, high] = rows(j, from, to);
      *(end + 1) = *end + static_cast<std::int32_t>(high - low) + (diagonals ? 1 : 0);
      ++end;
    }
    result.resizeNonZeros(*end);
    std::int32_t* row = result.innerIndexPtr();
    double* value = result.valuePtr();
    for (std::int32_t j = first; j < last; ++j) {
      stop::look_at_turn<stop::quick>(at(j), assembling);
      if (diagonals) {
        *row++ = j - from;
        *value++ = _diagonal[at(j)];
      }
      const auto [low, high] = rows(j, from, to);
      for (const Entry* entry = low; entry != high; ++entry) {
        *row++ = entry->row - from;
        *value++ = entry->value;
      }
    }
    return result;
  }

 private:
  void add(const Triangulation& part, const std::int32_t* node, const Isotropic& isotropic,
           std::int32_t free) {
    std::array<std::array<double, 2>, 3> edge{};  // edge[a] is opposite to corner a
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t from = 2 * at(node[(a + 1) % 3]), to = 2 * at(node[(a + 2) % 3]);
      edge[a] = isotropic(part.xy[to] - part.xy[from], part.xy[to + 1] - part.xy[from + 1]);
    }
    const double twice_area = edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
    // grad(phi_a) is edge[a] turned by a right angle over twice the area.
    const auto entry = [&](std::size_t a, std::size_t b) {
      const double dot = edge[a][0] * edge[b][0] + edge[a][1] * edge[b][1];
      return isotropic.tension * (dot / (2.0 * twice_area));
    };
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      _diagonal[at(node[a])] += entry(a, a);
      const Place to = place_in(node[a], node[b], free);
      _entries[at(_end[at(to.column)]++)] = {entry(a, b), to.row};
    }
  }

  /// Sorts column j, which begins at `begin`, by rows and adds the entries of the same row. A
  /// column has few entries, and those of one row must keep their order. Returns where the next
  /// begins.
  std::int32_t merge(std::size_t j, std::int32_t begin) {
    const std::int32_t end = _end[j];
    Entry* const first = _entries.data() + begin;
    Entry* last = first;
    for (Entry* next = first; next != _entries.data() + end; ++next) {
      const Entry entry = *next;
      Entry* hole = last;
      while (hole != first && (hole - 1)->row > entry.row) --hole;
      if (hole != first && (hole - 1)->row == entry.row) {
        (hole - 1)->value += entry.value;
        continue;
      }
      std::copy_backward(hole, last, last + 1);
      *hole = entry;
      ++last;
    }
    _begin.push_back(begin);
    _end[j] = static_cast<std::int32_t>(last - _entries.data());
    return end;
  }

  std::array<const Entry*, 2> rows(std::int32_t j, std::int32_t from, std::int32_t to) const {
    const Entry *low = _entries.data() + _begin[at(j)], *high = _entries.data() + _end[at(j)];
    while (low != high && low->row < from) ++low;
    while (low != high && (high - 1)->row >= to) --high;
    return {low, high};
  }

  std::vector<std::int32_t> _begin, _end;
  std::vector<double> _diagonal;
  std::vector<Entry> _entries;
};

}  // namespace

Stiffness stiffness(const Triangulation& part, const Tension& tension, Eigen::Index free) {
  const auto nodes = static_cast<std::int32_t>(part.node_count());
  const auto first = static_cast<std::int32_t>(free);
  const Columns columns(part, tension, first);
  return {columns.block(0, first, 0, first, true), columns.block(first, nodes, 0, first, false),
          columns.block(first, nodes, first, nodes, true).selfadjointView<Eigen::Lower>()};
}

}  // namespace anticrack::fem
