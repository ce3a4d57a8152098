// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/smooth_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace anticrack::fem {
namespace {

/// Barycentric coordinates, in the whole triangle, of the corners of a part of it.
using CornerWeights = std::array<std::array<double, 3>, 3>;

constexpr int deepest = 3;

struct LinePoint {
  double part;
  double weight;
};

/// Gauss-Legendre rule of degree 13 on (0, 1).
const std::array<LinePoint, 7>& gauss_rule() {
  static const auto rule = [] {
    constexpr std::array<double, 3> t{0.405845151377397166907, 0.741531185599394439864,
                                      0.949107912342758524526};
    constexpr std::array<double, 3> w{0.381830050505118944950, 0.279705391489276667901,
                                      0.129484966168869693271};
    std::array<LinePoint, 7> points{};
    points[3] = {0.5, 0.5 * 0.417959183673469387755};
    for (std::size_t i = 0; i < 3; ++i) {
      points[2 - i] = {0.5 - 0.5 * t[i], 0.5 * w[i]};
      points[4 + i] = {0.5 + 0.5 * t[i], 0.5 * w[i]};
    }
    return points;
  }();
  return rule;
}

/// int f phi_i by the product rule in coordinates collapsed at the first corner.
std::array<double, 3> product_rule(const Triangle& triangle, CountedField& field) {
  const auto& [a, b, c] = triangle;
  const double doubled_area = 2 * area(triangle);
  std::array<double, 3> nodal{};
  for (const LinePoint& out : gauss_rule()) {
    for (const LinePoint& across : gauss_rule()) {
      const double at_b = out.part * (1 - across.part), at_c = out.part * across.part;
      const double value = field(a.x + at_b * (b.x - a.x) + at_c * (c.x - a.x),
                                 a.y + at_b * (b.y - a.y) + at_c * (c.y - a.y));
      const double weighted = doubled_area * out.part * out.weight * across.weight * value;
      nodal[0] += (1 - out.part) * weighted;
      nodal[1] += at_b * weighted;
      nodal[2] += at_c * weighted;
    }
  }
  return nodal;
}

Triangle place(const Triangle& whole, const CornerWeights& part) {
  const auto& [a, b, c] = whole;
  Triangle triangle{};
  for (std::size_t i = 0; i < 3; ++i) {
    triangle[i] = {a.x + part[i][1] * (b.x - a.x) + part[i][2] * (c.x - a.x),
                   a.y + part[i][1] * (b.y - a.y) + part[i][2] * (c.y - a.y)};
  }
  return triangle;
}

std::array<CornerWeights, 4> quarters(const CornerWeights& part) {
  CornerWeights middle{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      middle[i][k] = 0.5 * (part[(i + 1) % 3][k] + part[(i + 2) % 3][k]);
    }
  }
  return {{{{part[0], middle[2], middle[1]}},
           {{middle[2], part[1], middle[0]}},
           {{middle[1], middle[0], part[2]}},
           {{middle[0], middle[1], middle[2]}}}};
}

class Refinement {
 public:
  Refinement(const Triangle& whole, CountedField& field) : _whole(whole), _field(field) {}

  bool add(const CornerWeights& part, const SampledTriangle& sampled, double tolerance, int depth) {
    if (sampled.error <= tolerance) {
      collect(part, sampled.nodal, sampled.error);
      return true;
    }
    if (sampled.rough || _field.spent()) {
      return false;
    }
    if (sampled.product_error <= tolerance) {
      const std::array<double, 3> nodal = product_rule(place(_whole, part), _field);
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(nodal[i] - sampled.nodal[i]) > sampled.error + tolerance) {
          return false;  // so the decay was not what it seemed
        }
      }
      collect(part, nodal, sampled.product_error);
      return true;
    }
    if (depth == deepest) {
      return false;
    }
    for (const CornerWeights& quarter : quarters(part)) {
      if (!add(quarter, sample_triangle(place(_whole, quarter), _field), tolerance / 4,
               depth + 1)) {
        return false;
      }
    }
    return true;
  }

  const std::array<double, 3>& nodal() const { return _nodal; }
  double error() const { return _error; }

 private:
  void collect(const CornerWeights& part, const std::array<double, 3>& nodal, double error) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        _nodal[i] += part[k][i] * nodal[k];
      }
    }
    _error += error;
  }

  const Triangle& _whole;
  CountedField& _field;
  std::array<double, 3> _nodal{};
  double _error = 0;
};

}  // namespace

bool refine_smooth_triangle(const Triangle& triangle, double tolerance, SampledTriangle& part,
                            CountedField& field) {
  Refinement refinement(triangle, field);
  if (!refinement.add({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, part, tolerance, 0)) {
    return false;
  }
  part.nodal = refinement.nodal();
  part.error = refinement.error();
  return true;
}

}  // namespace anticrack::fem
