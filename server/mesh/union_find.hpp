// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace anticrack::mesh {

/// Disjoint sets of 0..n-1. The smallest member stands for its set, whatever the order in which
/// they were united. O(log n) a call, amortised.
class UnionFind {
 public:
  /// Each a set of its own.
  explicit UnionFind(std::size_t n) : _parent(n) { std::iota(_parent.begin(), _parent.end(), 0); }

  /// What stands for the set of i.
  std::int32_t find(std::int32_t i) {
    while (parent(i) != i) {
      parent(i) = parent(parent(i));
      i = parent(i);
    }
    return i;
  }
  /// False when they were one set before.
  bool unite(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    (a < b ? parent(b) : parent(a)) = a < b ? a : b;
    return a != b;
  }
  /// Whether they are in one set.
  bool same(std::int32_t a, std::int32_t b) { return find(a) == find(b); }

 private:
  std::int32_t& parent(std::int32_t i) { return _parent[static_cast<std::size_t>(i)]; }

  std::vector<std::int32_t> _parent;
};

}  // namespace anticrack::mesh
