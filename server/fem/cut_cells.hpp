// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "fem/integration.hpp"

namespace anticrack::fem {

/// Finds the triangles in which a switch of f changes and cuts them along the lines where it does.
/// A switch's argument is taken for a polynomial of degree 2 on a cell, by 6 samples, and a seventh
/// says whether it is one. Straight lines leave triangles; a curved one leaves a straight triangle
/// and two with a curved side, whose points are found along rays; what is more involved (curves
/// that cross, touch or end) is quartered until it is too small to matter.
class Cutter {
 public:
  explicit Cutter(Integration& integration, std::stop_token stop);
  ~Cutter();

  bool needed() const noexcept;

  /// Of looking for cuts in a triangle, ns.
  double cost() const noexcept;

  /// Triangles looked at at once.
  static constexpr std::size_t width = 32;
  using Lane = std::array<double, width>;
  /// Where they are: the first corner, and from there to the two others.
  struct Frames {
    Lane x, y, bx, by, cx, cy;
  };

  /// Marks the triangles that are to be cut.
  void find(const Frames& frames, std::array<bool, width>& cut);

  /// Cuts triangles; adds what lies along curves to the load, and returns the triangles left.
  std::vector<Cell> cut(const std::vector<std::int32_t>& triangles);

 private:
  class Work;
  std::unique_ptr<Work> _work;
};

}  // namespace anticrack::fem
