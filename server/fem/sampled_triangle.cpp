// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/sampled_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace anticrack::fem {
namespace {

constexpr std::size_t sample_count = 15, boundary_count = 6;

struct RulePoint {
  std::array<double, 3> barycentric;
  double weight;  ///< part of the area
};

/// The one solution of the moment equations of degree 6 with orbits of 3, 3, 3 and 6 points that
/// hold the corners and the middles of the edges; no point lies outside.
std::array<RulePoint, sample_count> make_rule() {
  constexpr double corner = 0.0074169536109872963526, middle = 0.0257071721312435081875;
  constexpr double a = 0.4192760285723959851969, at_a = 0.1505821501276794522813;
  constexpr double b = 0.0589324540617404550161, c = 0.1947903549194651743153;
  constexpr double d = 1 - b - c, at_bcd = 0.0748135287317115382558;
  return {{{{1, 0, 0}, corner},
           {{0, 1, 0}, corner},
           {{0, 0, 1}, corner},
           {{0, 0.5, 0.5}, middle},
           {{0.5, 0, 0.5}, middle},
           {{0.5, 0.5, 0}, middle},
           {{1 - 2 * a, a, a}, at_a},
           {{a, 1 - 2 * a, a}, at_a},
           {{a, a, 1 - 2 * a}, at_a},
           {{b, c, d}, at_bcd},
           {{b, d, c}, at_bcd},
           {{c, b, d}, at_bcd},
           {{c, d, b}, at_bcd},
           {{d, b, c}, at_bcd},
           {{d, c, b}, at_bcd}}};
}

const std::array<RulePoint, sample_count>& rule() {
  static const auto points = make_rule();
  return points;
}

using Functional = std::array<double, sample_count>;

double dot(const Functional& a, const Functional& b) {
  double sum = 0;
  for (std::size_t i = 0; i < sample_count; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

/// An orthonormal basis on the samples: polynomials by ascending degree, so the last 5 vanish on
/// cubics.
std::array<Functional, sample_count> make_basis() {
  constexpr double dependent = 1e-6;
  std::array<Functional, sample_count> basis{};
  std::size_t count = 0;
  for (int degree = 0; count < sample_count; ++degree) {
    for (int power = 0; power <= degree && count < sample_count; ++power) {
      Functional p{};
      for (std::size_t i = 0; i < sample_count; ++i) {
        p[i] = std::pow(rule()[i].barycentric[0] - 1.0 / 3, power) *
               std::pow(rule()[i].barycentric[1] - 1.0 / 3, degree - power);
      }
      const double before = std::sqrt(dot(p, p));
      for (int pass = 0; pass < 2; ++pass) {  // once is not orthogonal to rounding
        for (std::size_t other = 0; other < count; ++other) {
          const double overlap = dot(basis[other], p);
          for (std::size_t i = 0; i < sample_count; ++i) {
            p[i] -= overlap * basis[other][i];
          }
        }
      }
      const double norm = std::sqrt(dot(p, p));
      if (norm > dependent * before) {
        for (double& value : p) {
          value /= norm;
        }
        basis[count++] = p;
      }
    }
  }
  return basis;
}

struct Decay {
  double bend;  ///< terms of degree 2 or 3, the greater; root mean square over the samples
  double rest;  ///< what a cubic misses
};

Decay decay(const Functional& values) {
  static const auto basis = make_basis();
  constexpr std::size_t linear_count = 3, quadratic_count = 6, cubic_count = 10;
  const auto size = [&values](std::size_t from, std::size_t to) {
    double square = 0;
    for (std::size_t k = from; k < to; ++k) {
      const double term = dot(basis[k], values);
      square += term * term;
    }
    return std::sqrt(square / sample_count);
  };
  return {std::max(size(linear_count, quadratic_count), size(quadratic_count, cubic_count)),
          size(cubic_count, sample_count)};
}

double edge(const Point& a, const Point& b) noexcept {
  return std::hypot(b.x - a.x, b.y - a.y);
}

}  // namespace

double area(const Triangle& triangle) noexcept {
  const auto& [a, b, c] = triangle;
  return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

double longest_edge(const Triangle& triangle) noexcept {
  const auto& [a, b, c] = triangle;
  return std::max({edge(a, b), edge(b, c), edge(c, a)});
}

double magnitude(const Triangle& triangle) noexcept {
  double greatest = 0;
  for (const Point& corner : triangle) {
    greatest = std::max({greatest, std::abs(corner.x), std::abs(corner.y)});
  }
  return greatest;
}

double drawn_in(const Triangle& triangle) noexcept {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  const double height = 2 * area(triangle) / longest_edge(triangle);
  return 1 - 3 * std::min(std::max(1e-13, rounding * magnitude(triangle) / height), 1e-2);
}

SampledTriangle sample_triangle(const Triangle& triangle, CountedField& field) {
  const double whole = area(triangle), shrink = drawn_in(triangle);
  const std::array<RulePoint, sample_count>& points = rule();
  SampledTriangle result;
  Functional values{};
  for (std::size_t i = 0; i < sample_count; ++i) {
    const auto& [barycentric, weight] = points[i];
    std::array<double, 3> at = barycentric;
    if (i < boundary_count) {
      for (double& part : at) {
        part = shrink * part + (1 - shrink) / 3;
      }
    }
    const auto& [a, b, c] = triangle;
    // From a corner, so that the point is right to the rounding of the triangle's own size.
    values[i] = field(a.x + at[1] * (b.x - a.x) + at[2] * (c.x - a.x),
                      a.y + at[1] * (b.y - a.y) + at[2] * (c.y - a.y));
    for (std::size_t k = 0; k < 3; ++k) {
      result.nodal[k] += whole * weight * barycentric[k] * values[i];
    }
    result.absolute += whole * weight * std::abs(values[i]);
  }
  const Decay found = decay(values);
  const double ratio = found.bend > 0 ? found.rest / found.bend : 1;
  // The rest begins at degree 4, and `ratio` is lost in two degrees; 2 for safety.
  const double loss = std::min(1.0, 2 * ratio);
  result.error = whole * found.rest * loss;
  result.product_error = result.error * loss * loss * loss;
  result.rough = ratio > 0.05;
  return result;
}

}  // namespace anticrack::fem
