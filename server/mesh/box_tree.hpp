// SPDX-License-Identifier: GPL-3.0-or-later
//
// A tree of bounding boxes of points or segments, to find those near a place: usually O(log k) of
// k.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

struct Box {
  Point low{};
  Point high{};
  double value = 0;  ///< the deciding one of its items
  std::size_t begin = 0;
  std::size_t end = 0;   ///< end of the range of its items
  std::size_t left = 0;  ///< index of its two parts; 0: none
  std::size_t right = 0;
};

/// Sorts the items, at least one, into boxes; the first has all, one without parts at most
/// `in_a_leaf`. ends(item): its two ends, as std::array; value(item): a number; decide(a, b): which
/// of two numbers a box keeps. O(k log k).
template <class Item, class Ends, class Value, class Decide>
std::vector<Box> boxes_of(std::vector<Item>& items, std::size_t in_a_leaf, const Ends& ends,
                          const Value& value, const Decide& decide) {
  std::vector<Box> boxes;
  boxes.reserve(2 * items.size());
  const auto build = [&](const auto& again, std::size_t begin, std::size_t end) -> std::size_t {
    const std::size_t index = boxes.size();
    const Point corner = ends(items[begin])[0];
    Box box{corner, corner, value(items[begin]), begin, end, 0, 0};
    for (std::size_t i = begin; i < end; ++i) {
      for (const Point& p : ends(items[i])) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
          box.low[axis] = std::min(box.low[axis], p[axis]);
          box.high[axis] = std::max(box.high[axis], p[axis]);
        }
      }
      box.value = decide(box.value, value(items[i]));
    }
    boxes.push_back(box);
    if (end - begin <= in_a_leaf) return index;
    const std::size_t axis = box.high[0] - box.low[0] > box.high[1] - box.low[1] ? 0 : 1;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto place = [&](std::size_t i) {
      return items.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(place(begin), place(middle), place(end),
                     [&ends, axis](const Item& c, const Item& d) {
                       const std::array<Point, 2> of_c = ends(c), of_d = ends(d);
                       return of_c[0][axis] + of_c[1][axis] < of_d[0][axis] + of_d[1][axis];
                     });
    const std::size_t left = again(again, begin, middle);
    const std::size_t right = again(again, middle, end);
    boxes[index].left = left;
    boxes[index].right = right;
    return index;
  };
  build(build, 0, items.size());
  return boxes;
}

}  // namespace anticrack::mesh
