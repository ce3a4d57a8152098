// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "fem/integration.hpp"

namespace anticrack::fem {

/// Finds the triangles in which a switch of f changes and cuts them along the lines of change. The
/// argument of a switch is approximated on a cell by a polynomial of degree 2 through 6 samples; a
/// seventh checks it. A straight line leaves triangles. A curved line leaves a triangle and two
/// cells with a curved side, whose points are found along rays. Cells with more than one line, or
/// with the end of a line, are quartered until they are too small to matter.
class Cutter {
 public:
  explicit Cutter(Integration& integration);
  ~Cutter();

  bool needed() const noexcept;

  /// Time of find() for a triangle, ns.
  double cost() const noexcept;

  /// How many triangles find() takes at once.
  static constexpr std::size_t width = 32;
  using Lane = std::array<double, width>;
  /// The first corner of each, and the vectors from there to the two others.
  struct Frames {
    Lane x, y, bx, by, cx, cy;
  };

  /// Marks the triangles that are to be cut.
  void find(const Frames& frames, std::array<bool, width>& cut);

  /// Cuts triangles; adds the parts along curves to the load and returns the triangles left.
  std::vector<Cell> cut(const std::vector<std::int32_t>& triangles);

 private:
  class Work;
  std::unique_ptr<Work> _work;
};

}  // namespace anticrack::fem
