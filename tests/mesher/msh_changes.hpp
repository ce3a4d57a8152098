// SPDX-License-Identifier: GPL-3.0-or-later
//
// What tests change about samples.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesher/msh_writer.hpp"

namespace anticrack::testing {

/// The triangles that `inside` is true of (by their centre) get nodes of their own at these points,
/// numbered on from 1000.
template <class Inside>
void double_nodes(MshSample& sample, const std::vector<std::array<double, 2>>& at,
                  const Inside& inside) {
  std::map<int, std::array<double, 2>> place;
  for (std::size_t i = 0; i < sample.tags.size(); ++i) {
    place[sample.tags[i]] = {sample.points[i][0], sample.points[i][1]};
  }
  std::map<int, int> copies;
  for (const auto& [x, y] : at) {
    const int tag = sample.node(x, y);
    const int copy = std::max(999, *std::max_element(sample.tags.begin(), sample.tags.end())) + 1;
    copies[tag] = copy;
    sample.tags.push_back(copy);
    sample.points.push_back({x, y, 0});
  }
  for (auto& t : sample.triangles) {
    double x = 0;
    double y = 0;
    for (const int node : t.nodes) {
      x += place[node][0] / 3;
      y += place[node][1] / 3;
    }
    if (!inside(x, y)) continue;
    for (int& node : t.nodes) {
      if (copies.contains(node)) node = copies[node];
    }
  }
}

/// The same for the upper half of `square_sample`, at these x of y = 0.
inline void open_middle(MshSample& sample, const std::vector<double>& xs) {
  std::vector<std::array<double, 2>> at;
  at.reserve(xs.size());
  for (const double x : xs) at.push_back({x, 0});
  double_nodes(sample, at, [](double, double y) { return y > 0; });
}

/// All triangles in one physical surface, "all".
inline void make_one_surface(MshSample& sample) {
  for (auto& t : sample.triangles) t.group = 1, t.entity = 21;
  std::erase_if(sample.names, [](const MshName& n) { return n.dimension == 2; });
  sample.names.push_back({2, 1, "all"});
}

/// Without physical groups.
inline void remove_groups(MshSample& sample) {
  for (auto& t : sample.triangles) t.group = 0;
  for (auto& line : sample.lines) line.group = 0;
  sample.names.clear();
}

/// A line through these nodes, from each to the next.
inline void add_lines(MshSample& sample, const std::vector<std::array<double, 2>>& points, int tag,
                      const std::string& name) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const int a = sample.node(points[i][0], points[i][1]);
    const int b = sample.node(points[i + 1][0], points[i + 1][1]);
    sample.lines.push_back({{a, b}, tag, tag + 100});
  }
  if (!name.empty()) sample.names.push_back({1, tag, name});
}

}  // namespace anticrack::testing
