// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace anticrack::mesher {

/// Disjoint sets of 0..n-1. A set is known by its lowest member, so what follows from it does not
/// depend on the order of `unite`.
class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : _parent(n) {
    std::iota(_parent.begin(), _parent.end(), std::int32_t{0});
  }

  std::int32_t find(std::int32_t i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }

  void unite(std::int32_t a, std::int32_t b) {
    a = find(a);
    b = find(b);
    if (a > b) std::swap(a, b);
    parent(b) = a;
  }

 private:
  std::int32_t& parent(std::int32_t i) { return _parent[static_cast<std::size_t>(i)]; }

  std::vector<std::int32_t> _parent;
};

}  // namespace anticrack::mesher
