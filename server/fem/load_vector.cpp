// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load_vector.hpp"

#include "fem/expression.hpp"
#include "fem/quadrature.hpp"

namespace anticrack::fem {
namespace {

struct Corners {
  std::array<Eigen::Index, 3> node;
  std::array<Eigen::Vector2d, 3> at;
  double area;
};

Corners corners(const Triangulation& part, std::size_t triangle) {
  Corners result{};
  for (std::size_t a = 0; a < 3; ++a) {
    result.node[a] = part.triangles[3 * triangle + a];
    result.at[a] =
        Eigen::Map<const Eigen::Vector2d>(&part.xy[2 * static_cast<std::size_t>(result.node[a])]);
  }
  const Eigen::Vector2d p = result.at[1] - result.at[0], q = result.at[2] - result.at[0];
  result.area = 0.5 * (p.x() * q.y() - p.y() * q.x());
  return result;
}

struct AssembleForce {
  const Triangulation& part;
  const std::string& region;

  Eigen::VectorXd zero() const {
    return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(part.node_count()));
  }

  Eigen::VectorXd operator()(double value) const {
    Eigen::VectorXd load = zero();
    for (std::size_t t = 0; t < part.triangle_count(); ++t) {
      const Corners triangle = corners(part, t);
      for (const Eigen::Index node : triangle.node) {
        load[node] += value * triangle.area / 3;
      }
    }
    return load;
  }

  Eigen::VectorXd operator()(const PerRegion& regions) const {
    const auto found = regions.values.find(region);
    return found == regions.values.end() ? zero() : (*this)(found->second);
  }

  Eigen::VectorXd operator()(const Expression& expression) const {
    ExpressionFunction force(expression.text, "force.expression");
    Eigen::VectorXd load = zero();
    for (std::size_t t = 0; t < part.triangle_count(); ++t) {
      const Corners triangle = corners(part, t);
      for (const QuadraturePoint& point : degree_five_rule()) {
        const Eigen::Vector2d at = point.barycentric[0] * triangle.at[0] +
                                   point.barycentric[1] * triangle.at[1] +
                                   point.barycentric[2] * triangle.at[2];
        const double weighted = point.weight * triangle.area * force(at.x(), at.y());
        for (std::size_t a = 0; a < 3; ++a) {
          load[triangle.node[a]] += weighted * point.barycentric[a];
        }
      }
    }
    return load;
  }
};

}  // namespace

Eigen::VectorXd load_vector(const Triangulation& part, const Force& force,
                            const std::string& region) {
  return std::visit(AssembleForce{part, region}, force);
}

Eigen::VectorXd boundary_values(const Triangulation& part, const std::string& text,
                                std::size_t first, std::size_t count) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  if (text.empty()) {
    return values;
  }
  ExpressionFunction function(text, "boundary_value");
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t node = first + i;
    values[static_cast<Eigen::Index>(i)] = function(part.xy[2 * node], part.xy[2 * node + 1]);
  }
  return values;
}

}  // namespace anticrack::fem
