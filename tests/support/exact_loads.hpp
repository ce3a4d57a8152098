// SPDX-License-Identifier: GPL-3.0-or-later
//
// Loads of fields that jump along lines and circles, by exact geometry: what the code under test
// must find without being told where the jumps are.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace anticrack::testing {

struct PlaneMesh {
  std::vector<double> xy;
  std::vector<std::int32_t> triangles;

  std::size_t node_count() const { return xy.size() / 2; }
  std::size_t triangle_count() const { return triangles.size() / 3; }
};

using PlanePoint = std::array<double, 2>;
using Polygon = std::vector<PlanePoint>;
using Field = std::function<double(double, double)>;

/// Corners of triangle t.
inline Polygon corners(const PlaneMesh& mesh, std::size_t t) {
  Polygon result;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto node = static_cast<std::size_t>(mesh.triangles[3 * t + i]);
    result.push_back({mesh.xy[2 * node], mesh.xy[2 * node + 1]});
  }
  return result;
}

inline double polygon_area(const Polygon& p) {
  double doubled = 0;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    doubled += (p[i][0] - p[0][0]) * (p[i + 1][1] - p[0][1]) -
               (p[i][1] - p[0][1]) * (p[i + 1][0] - p[0][0]);
  }
  return 0.5 * doubled;
}

/// (-1, 1)^2 in 2 n^2 triangles; nodes inside are moved by up to `shake` of the mesh size (< 0.25
/// keeps every triangle counterclockwise).
inline PlaneMesh square_mesh(std::size_t n, double shake, unsigned seed) {
  PlaneMesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-shake, shake);
  const double h = 2.0 / static_cast<double>(n);
  for (std::size_t j = 0; j <= n; ++j) {
    for (std::size_t i = 0; i <= n; ++i) {
      const bool inside = i > 0 && i < n && j > 0 && j < n;
      const double dx = inside && shake > 0 ? move(random) : 0;
      const double dy = inside && shake > 0 ? move(random) : 0;
      mesh.xy.push_back(-1 + h * (static_cast<double>(i) + dx));
      mesh.xy.push_back(-1 + h * (static_cast<double>(j) + dy));
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto a = static_cast<std::int32_t>(j * (n + 1) + i), b = a + 1;
      const auto c = a + static_cast<std::int32_t>(n + 1), d = c + 1;
      for (const std::int32_t node : {a, b, d, a, d, c}) {
        mesh.triangles.push_back(node);
      }
    }
  }
  return mesh;
}

/// a x + b y = c
struct Line {
  double a;
  double b;
  double c;
};

/// The part of a convex polygon where side * (a x + b y - c) >= 0.
inline Polygon clip(const Polygon& p, const Line& line, double side) {
  Polygon result;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const PlanePoint &u = p[i], &v = p[(i + 1) % p.size()];
    const double at_u = side * (line.a * u[0] + line.b * u[1] - line.c);
    const double at_v = side * (line.a * v[0] + line.b * v[1] - line.c);
    if (at_u >= 0) {
      result.push_back(u);
    }
    if ((at_u > 0 && at_v < 0) || (at_u < 0 && at_v > 0)) {
      const double part = at_u / (at_u - at_v);
      result.push_back({u[0] + part * (v[0] - u[0]), u[1] + part * (v[1] - u[1])});
    }
  }
  return result;
}

/// Calls visit(x, y, weight) for a rule of degree 9 over a convex polygon (5 x 5 Gauss points per
/// triangle of a fan, coordinates collapsed at its apex).
template <class Visit>
void visit_polygon(const Polygon& p, Visit&& visit) {
  static constexpr std::array<double, 5> t{-0.90617984593866399280, -0.53846931010568309104, 0,
                                           0.53846931010568309104, 0.90617984593866399280};
  static constexpr std::array<double, 5> w{0.23692688505618908751, 0.47862867049936646804,
                                           0.56888888888888888889, 0.47862867049936646804,
                                           0.23692688505618908751};
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    const double doubled = 2 * polygon_area({p[0], p[i], p[i + 1]});
    for (std::size_t j = 0; j < 5; ++j) {
      for (std::size_t k = 0; k < 5; ++k) {
        const double r = 0.5 + 0.5 * t[j], s = 0.5 + 0.5 * t[k];
        const double b = r * (1 - s), c = r * s;
        visit(p[0][0] + b * (p[i][0] - p[0][0]) + c * (p[i + 1][0] - p[0][0]),
              p[0][1] + b * (p[i][1] - p[0][1]) + c * (p[i + 1][1] - p[0][1]),
              0.25 * w[j] * w[k] * r * doubled);
      }
    }
  }
}

/// Barycentric coordinates in a triangle.
inline std::array<double, 3> barycentric(const Polygon& triangle, double x, double y) {
  const double whole = polygon_area(triangle);
  const PlanePoint at{x, y};
  return {polygon_area({at, triangle[1], triangle[2]}) / whole,
          polygon_area({triangle[0], at, triangle[2]}) / whole,
          polygon_area({triangle[0], triangle[1], at}) / whole};
}

/// int f phi_i where f is a polynomial of degree at most 6 on each side of the lines.
inline std::vector<double> loads_cut_by_lines(const PlaneMesh& mesh, const std::vector<Line>& lines,
                                              const Field& f) {
  std::vector<double> load(mesh.node_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Polygon triangle = corners(mesh, t);
    std::vector<Polygon> pieces{triangle};
    for (const Line& line : lines) {
      std::vector<Polygon> finer;
      for (const Polygon& piece : pieces) {
        for (const double side : {1.0, -1.0}) {
          Polygon part = clip(piece, line, side);
          if (part.size() >= 3) {
            finer.push_back(std::move(part));
          }
        }
      }
      pieces = std::move(finer);
    }
    for (const Polygon& piece : pieces) {
      visit_polygon(piece, [&](double x, double y, double weight) {
        const double value = weight * f(x, y);
        const std::array<double, 3> phi = barycentric(triangle, x, y);
        for (std::size_t i = 0; i < 3; ++i) {
          load[static_cast<std::size_t>(mesh.triangles[3 * t + i])] += value * phi[i];
        }
      });
    }
  }
  return load;
}

/// Area and first moments about the centre.
struct Moments {
  double area = 0;
  double x = 0;
  double y = 0;
};

/// Of the triangle (centre, a, b) cut with the disc of radius r, signed; a, b from the centre.
inline Moments disc_wedge(PlanePoint a, PlanePoint b, double r) {
  Moments sum;
  const auto straight = [&](const PlanePoint& p, const PlanePoint& q) {
    const double part = 0.5 * (p[0] * q[1] - p[1] * q[0]);
    sum.area += part;
    sum.x += part * (p[0] + q[0]) / 3;
    sum.y += part * (p[1] + q[1]) / 3;
  };
  const auto round = [&](const PlanePoint& p, const PlanePoint& q) {
    const double from = std::atan2(p[1], p[0]);
    const double turn = std::atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]);
    sum.area += 0.5 * r * r * turn;
    sum.x += r * r * r / 3 * (std::sin(from + turn) - std::sin(from));
    sum.y -= r * r * r / 3 * (std::cos(from + turn) - std::cos(from));
  };
  const PlanePoint d{b[0] - a[0], b[1] - a[1]};
  const double aa = d[0] * d[0] + d[1] * d[1], ab = a[0] * d[0] + a[1] * d[1];
  const double root = ab * ab - aa * (a[0] * a[0] + a[1] * a[1] - r * r);
  std::vector<double> ends{0.0};
  if (root > 0) {
    for (const double sign : {-1.0, 1.0}) {
      const double part = (-ab + sign * std::sqrt(root)) / aa;
      if (part > ends.back() && part < 1) {
        ends.push_back(part);
      }
    }
  }
  ends.push_back(1.0);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const auto at = [&](double part) { return PlanePoint{a[0] + part * d[0], a[1] + part * d[1]}; };
    const PlanePoint middle = at(0.5 * (ends[i - 1] + ends[i]));
    if (std::hypot(middle[0], middle[1]) < r) {
      straight(at(ends[i - 1]), at(ends[i]));
    } else {
      round(at(ends[i - 1]), at(ends[i]));
    }
  }
  return sum;
}

/// int phi_i over the part of the disc where a x + b y >= c for all lines, exactly.
inline std::vector<double> loads_of_disc(const PlaneMesh& mesh, PlanePoint centre, double radius,
                                         const std::vector<Line>& lines = {}) {
  std::vector<double> load(mesh.node_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Polygon triangle = corners(mesh, t);
    Polygon piece = triangle;
    for (const Line& line : lines) {
      piece = clip(piece, line, 1);
    }
    for (Polygon* polygon : {&triangle, &piece}) {
      for (PlanePoint& corner : *polygon) {
        corner = {corner[0] - centre[0], corner[1] - centre[1]};
      }
    }
    Moments sum;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Moments part = disc_wedge(piece[i], piece[(i + 1) % piece.size()], radius);
      sum.area += part.area;
      sum.x += part.x;
      sum.y += part.y;
    }
    const double doubled = 2 * polygon_area(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      const PlanePoint &j = triangle[(i + 1) % 3], &k = triangle[(i + 2) % 3];
      const double integral =
          sum.area * (j[0] * k[1] - k[0] * j[1]) + sum.x * (j[1] - k[1]) + sum.y * (k[0] - j[0]);
      load[static_cast<std::size_t>(mesh.triangles[3 * t + i])] += integral / doubled;
    }
  }
  return load;
}

/// int phi_i, the area that belongs to each node.
inline std::vector<double> node_areas(const PlaneMesh& mesh) {
  std::vector<double> areas(mesh.node_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const double third = polygon_area(corners(mesh, t)) / 3;
    for (std::size_t i = 0; i < 3; ++i) {
      areas[static_cast<std::size_t>(mesh.triangles[3 * t + i])] += third;
    }
  }
  return areas;
}

}  // namespace anticrack::testing
