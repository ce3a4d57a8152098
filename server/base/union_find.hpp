// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/at.hpp"

namespace anticrack::base {

/// Disjoint sets of 0..n-1, each represented by its smallest member. O(log n) a call, amortised.
class UnionFind {
 public:
  /// Makes n sets of one member.
  explicit UnionFind(std::size_t n) : _parent(n) { std::iota(_parent.begin(), _parent.end(), 0); }

  /// The representative of the set of i.
  std::int32_t find(std::int32_t i) {
    while (parent(i) != i) {
      parent(i) = parent(parent(i));
      i = parent(i);
    }
    return i;
  }
  /// Unites the sets of a and b; returns false if they were in one set already.
  bool unite(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    (a < b ? parent(b) : parent(a)) = a < b ? a : b;
    return a != b;
  }
  /// Whether a and b are in one set.
  bool same(std::int32_t a, std::int32_t b) { return find(a) == find(b); }

 private:
  std::int32_t& parent(std::int32_t i) { return _parent[at(i)]; }

  std::vector<std::int32_t> _parent;
};

}  // namespace anticrack::base
