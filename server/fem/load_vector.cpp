// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load_vector.hpp"

#include <array>

#include "fem/adaptive_load.hpp"
#include "fem/expression.hpp"

namespace anticrack::fem {
namespace {

struct AssembleForce {
  const Triangulation& part;
  const std::string& region;
  const LoadContext& context;

  Eigen::VectorXd zero() const {
    return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(part.node_count()));
  }

  std::array<Eigen::Index, 3> corners(std::size_t t) const {
    return {part.triangles[3 * t], part.triangles[3 * t + 1], part.triangles[3 * t + 2]};
  }

  double area(std::size_t t) const { return part.area.empty() ? part.area_of(t) : part.area[t]; }

  /// int f phi_i for f constant on triangles; value(t) on the t-th.
  template <class Value>
  Eigen::VectorXd constant_on_triangles(const Value& value) const {
    Eigen::VectorXd load = zero();
    for (std::size_t t = 0; t < part.triangle_count(); ++t) {
      const std::array<Eigen::Index, 3> nodes = corners(t);
      const double third = value(t) * area(t) / 3;
      for (const Eigen::Index node : nodes) {
        load[node] += third;
      }
    }
    return load;
  }

  /// By the exact mass matrix of a triangle, area/12 (1 + delta_ij).
  Eigen::VectorXd linear_on_triangles(const std::vector<double>& of_node) const {
    // Near nodes have near numbers here but not in the mesh: each value is fetched once.
    Eigen::VectorXd local(static_cast<Eigen::Index>(part.node_count()));
    for (std::size_t i = 0; i < part.node_count(); ++i) {
      local[static_cast<Eigen::Index>(i)] = of_node[static_cast<std::size_t>(context.node[i])];
    }
    Eigen::VectorXd load = zero();
    for (std::size_t t = 0; t < part.triangle_count(); ++t) {
      const std::array<Eigen::Index, 3> nodes = corners(t);
      std::array<double, 3> value{};
      for (std::size_t a = 0; a < 3; ++a) {
        value[a] = local[nodes[a]];
      }
      const double part_of_area = area(t) / 12, sum = value[0] + value[1] + value[2];
      for (std::size_t a = 0; a < 3; ++a) {
        load[nodes[a]] += part_of_area * (sum + value[a]);
      }
    }
    return load;
  }

  Eigen::VectorXd operator()(double value) const {
    return constant_on_triangles([value](std::size_t) { return value; });
  }

  Eigen::VectorXd operator()(const PerRegion& regions) const {
    const auto found = regions.values.find(region);
    return found == regions.values.end() ? zero() : (*this)(found->second);
  }

  Eigen::VectorXd operator()(const Array& array) const {
    const std::vector<double>& values = *array.values;
    if (!array.per_triangle) {
      return linear_on_triangles(values);
    }
    return constant_on_triangles(
        [&](std::size_t t) { return values[static_cast<std::size_t>(context.triangle[t])]; });
  }

  Eigen::VectorXd operator()(const Expression& expression) const {
    ExpressionFunction force(expression.text, "force.expression");
    Eigen::VectorXd load = zero();
    IntegrationLimits limits;
    limits.relative_tolerance = load_tolerance;
    const IntegrationReport report = integrate_load(
        part.xy, part.triangles, [&force](double x, double y) { return force(x, y); },
        {load.data(), part.node_count()}, limits, context.stop);
    if (context.relative_error != nullptr) {
      *context.relative_error = report.relative_error_estimate;
    }
    return load;
  }
};

}  // namespace

Eigen::VectorXd load_vector(const Triangulation& part, const Force& force,
                            const std::string& region, const LoadContext& context) {
  return std::visit(AssembleForce{part, region, context}, force);
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
