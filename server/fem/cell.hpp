// SPDX-License-Identifier: GPL-3.0-or-later
//
// Parts of the triangles of a mesh, over which loads are integrated.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace anticrack::fem {

/// A point of a triangle, by its second and third barycentric coordinates.
struct Place {
  double b;
  double c;
};

inline Place between(const Place& from, const Place& to, double part) {
  return {from.b + part * (to.b - from.b), from.c + part * (to.c - from.c)};
}

/// A triangle that is a part of a triangle of the mesh.
struct Cell {
  std::array<Place, 3> corners{{{0, 0}, {1, 0}, {0, 1}}};
  std::int32_t triangle = 0;
  std::int32_t depth = 0;  ///< how often it was divided
  double share = 1;        ///< its share of the error that its triangle may have
  bool divisible = true;   ///< false: it keeps a jump that is not worth more work

  Place at(double b, double c) const {
    return {corners[0].b + b * (corners[1].b - corners[0].b) + c * (corners[2].b - corners[0].b),
            corners[0].c + b * (corners[1].c - corners[0].c) + c * (corners[2].c - corners[0].c)};
  }
  /// Its area as a fraction of that of its triangle; negative if clockwise.
  double part() const {
    return (corners[1].b - corners[0].b) * (corners[2].c - corners[0].c) -
           (corners[1].c - corners[0].c) * (corners[2].b - corners[0].b);
  }
  Cell with(const Place& p, const Place& q, const Place& r, double of_share) const {
    return {{p, q, r}, triangle, depth, share * of_share, divisible};
  }
  std::array<Cell, 4> quarters() const {
    const auto& [p, q, r] = corners;
    const Place pq = between(p, q, 0.5), qr = between(q, r, 0.5), rp = between(r, p, 0.5);
    std::array<Cell, 4> cells{with(p, pq, rp, 0.5), with(pq, q, qr, 0.5), with(rp, qr, r, 0.5),
                              with(pq, qr, rp, 0.5)};
    for (Cell& cell : cells) ++cell.depth;
    return cells;
  }
};

/// The position of a triangle of the mesh.
struct Frame {
  double x, y;            ///< its first corner
  double bx, by, cx, cy;  ///< vectors from there to the other corners
  double area;            ///< if not positive, too small for the coordinates

  double at_x(const Place& p) const { return x + p.b * bx + p.c * cx; }
  double at_y(const Place& p) const { return y + p.b * by + p.c * cy; }
  double size() const {
    return std::max({std::hypot(bx, by), std::hypot(cx, cy), std::hypot(bx - cx, by - cy)});
  }
};

inline Frame frame_of(std::span<const double> xy, std::span<const std::int32_t> triangles,
                      std::size_t t) {
  const double* p = &xy[2 * static_cast<std::size_t>(triangles[3 * t])];
  const double* q = &xy[2 * static_cast<std::size_t>(triangles[3 * t + 1])];
  const double* r = &xy[2 * static_cast<std::size_t>(triangles[3 * t + 2])];
  Frame frame{p[0], p[1], q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1], 0};
  frame.area = 0.5 * (frame.bx * frame.cy - frame.by * frame.cx);
  return frame;
}

/// int f, int f phi_1 and int f phi_2 over a cell (phi_0 is the rest), and int |f|.
struct Moments {
  std::array<double, 3> value{};
  double absolute = 0;

  void add(double weight, const Place& p, double f) {
    const double part = weight * f;
    value[0] += part;
    value[1] += part * p.b;
    value[2] += part * p.c;
    absolute += std::abs(part);
  }
  void operator+=(const Moments& other) {
    for (std::size_t i = 0; i < 3; ++i) value[i] += other.value[i];
    absolute += other.absolute;
  }
};

/// The greatest difference of a nodal value.
inline double difference(const Moments& p, const Moments& q) {
  const double whole = p.value[0] - q.value[0], b = p.value[1] - q.value[1],
               c = p.value[2] - q.value[2];
  return std::max({std::abs(whole - b - c), std::abs(b), std::abs(c)});
}

}  // namespace anticrack::fem
