// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load_vector.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "base/at_once.hpp"
#include "expression/function.hpp"
#include "fem/adaptive_load.hpp"
#include "fem/cell.hpp"
#include "fem/load_parts.hpp"
#include "stop/stop.hpp"

namespace anticrack::fem {
namespace {

using CornerNodes = std::array<Eigen::Index, 3>;

constexpr const char* summing = "summing loads over a mesh";

CornerNodes corners(const Triangulation& part, std::size_t t) {
  return {part.triangles[3 * t], part.triangles[3 * t + 1], part.triangles[3 * t + 2]};
}

double area(const Triangulation& part, std::size_t t) {
  return frame_of(part.xy, part.triangles, t).area;
}

template <int width>
using Rows = Eigen::Matrix<double, width, Eigen::Dynamic>;  // each column belongs to a node

/// int f phi_i of `width` fields at once, by the exact mass matrix of a triangle, area/12 (1 +
/// delta_ij).
template <int width>
void linear_on_triangles(const Triangulation& part, const Rows<width>& of_node, Rows<width>& load) {
  using Values = Eigen::Array<double, width, 1>;
  load.setZero();
  for (std::size_t t = 0; t < part.triangle_count(); ++t) {
    stop::look_at_turn<stop::quick>(t, summing);
    const CornerNodes nodes = corners(part, t);
    const Values p = of_node.col(nodes[0]), q = of_node.col(nodes[1]), r = of_node.col(nodes[2]);
    const double part_of_area = area(part, t) / 12;
    const Values sum = p + q + r;
    load.col(nodes[0]).array() += part_of_area * (sum + p);
    load.col(nodes[1]).array() += part_of_area * (sum + q);
    load.col(nodes[2]).array() += part_of_area * (sum + r);
  }
}

/// Integrates arrays into the columns of `loads` from `first` on, `width` at once.
template <int width>
void integrate_arrays(const Triangulation& part, std::span<const std::int32_t> node,
                      std::span<const double* const> arrays, Eigen::Index first,
                      Eigen::MatrixXd& loads) {
  if (arrays.empty()) return;
  Rows<width> of_node = Rows<width>::Zero(width, loads.rows()), load(width, loads.rows());
  for (; !arrays.empty(); arrays = arrays.subspan(std::min<std::size_t>(width, arrays.size()))) {
    const auto count = std::min<Eigen::Index>(width, static_cast<Eigen::Index>(arrays.size()));
    for (Eigen::Index i = 0; i < loads.rows(); ++i) {
      stop::look_at_turn<stop::quick>(static_cast<std::size_t>(i), summing);
      for (Eigen::Index j = 0; j < count; ++j)
        of_node(j, i) = arrays[static_cast<std::size_t>(j)][node[static_cast<std::size_t>(i)]];
    }
    linear_on_triangles<width>(part, of_node, load);
    constexpr Eigen::Index tile = 64;  // as many rows as stay in the first-level cache
    for (Eigen::Index begin = 0; begin < loads.rows(); begin += tile) {
      stop::look_at_turn<stop::quick>(static_cast<std::size_t>(begin), summing);
      const Eigen::Index rows = std::min(tile, loads.rows() - begin);
      loads.block(begin, first, rows, count) =
          load.middleCols(begin, rows).topRows(count).transpose();
    }
    first += count;
  }
}

/// Values of a function at points (n,2).
std::vector<double> at_points(std::span<const double> xy, const expression::Function& function) {
  const std::size_t count = xy.size() / 2;
  constexpr std::size_t block = expression::Evaluator::block;
  const expression::Ref root = function.tape().result();
  expression::Evaluator evaluator(function.tape(), {&root, 1});
  std::array<double, block> x{}, y{};
  std::vector<double> values(count);
  for (std::size_t begin = 0; begin < count; begin += block) {
    const std::size_t n = std::min(block, count - begin);
    stop::look("integrating a load");
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = xy[2 * (begin + i)];
      y[i] = xy[2 * (begin + i) + 1];
    }
    evaluator(x.data(), y.data(), n);
    for (std::size_t i = 0; i < n; ++i) {
      values[begin + i] = evaluator.values(0)[i];
      function.require_finite(x[i], y[i], values[begin + i]);
    }
  }
  return values;
}

struct AssembleForce {
  const Triangulation& part;
  const std::string& region;
  const LoadContext& context;

  Eigen::VectorXd zero() const {
    return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(part.node_count()));
  }

  /// int f phi_i for f constant on triangles, value(t) on triangle t.
  template <class Value>
  Eigen::VectorXd constant_on_triangles(const Value& value) const {
    Eigen::VectorXd load = zero();
    for (std::size_t t = 0; t < part.triangle_count(); ++t) {
      stop::look_at_turn<stop::quick>(t, summing);
      const CornerNodes nodes = corners(part, t);
      const double third = value(t) * area(part, t) / 3;
      for (const Eigen::Index node : nodes) load[node] += third;
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
      const double* const one[] = {values.data()};
      return load_vectors(part, context.node, one);
    }
    return constant_on_triangles(
        [&](std::size_t t) { return values[static_cast<std::size_t>(context.triangle[t])]; });
  }

  Eigen::VectorXd operator()(const Expression& expression) const {
    const expression::Function force(expression.text, "force.expression");
    const expression::Tape& tape = force.tape();
    const int degree = tape.degree(tape.result());
    if (degree == 0)
      return (*this)(tape.operations()[static_cast<std::size_t>(tape.result())].value);
    if (degree == 1) {
      const std::vector<double> values = at_points(part.xy, force);
      const double* const one[] = {values.data()};
      std::vector<std::int32_t> own(part.node_count());
      std::iota(own.begin(), own.end(), 0);
      return load_vectors(part, own, one);
    }
    Eigen::VectorXd load = zero();
    const IntegrationReport report = integrate_load(
        part.xy, part.triangles, force, {load.data(), part.node_count()},
        limits_of(force_tolerance(part.triangle_count()), part.triangle_count()), context.parts);
    if (context.report != nullptr) *context.report = report;
    return load;
  }
};

struct LinearLoad {
  const Triangulation& part;
  const std::string& region;
  const LoadContext& context;
  const std::function<double*()>& room;
  const std::optional<std::span<const std::int32_t>>& only;

  /// Calls value(corner) for each corner of the triangles.
  template <class Value>
  bool linear(const Value& value) const {
    constexpr std::size_t some = 16384;
    const std::size_t count = only ? only->size() : part.triangle_count();
    double* const load = room();
    base::at_once((count + some - 1) / some, base::Threads::allowed(), [&] {
      return [&](std::size_t block) {
        stop::look(summing);
        for (std::size_t k = block * some; k < std::min(count, (block + 1) * some); ++k) {
          const std::size_t t = only ? static_cast<std::size_t>((*only)[k]) : k;
          const double twelfth = area(part, t) / 12;
          const std::array<double, 3> f{value(3 * t), value(3 * t + 1), value(3 * t + 2)};
          for (std::size_t i = 0; i < 3; ++i)
            load[3 * t + i] = twelfth * (f[0] + f[1] + f[2] + f[i]);
        }
      };
    });
    return true;
  }

  bool operator()(double value) const {
    return linear([value](std::size_t) { return value; });
  }
  bool operator()(const PerRegion& regions) const {
    const auto found = regions.values.find(region);
    return (*this)(found == regions.values.end() ? 0.0 : found->second);
  }
  bool operator()(const Array& array) const {
    const std::vector<double>& values = *array.values;
    return linear([&](std::size_t corner) {
      const std::int32_t place =
          array.per_triangle ? context.triangle[corner / 3]
                             : context.node[static_cast<std::size_t>(part.triangles[corner])];
      return values[static_cast<std::size_t>(place)];
    });
  }
  bool operator()(const Expression& expression) const {
    const expression::Function force(expression.text, "force.expression");
    const expression::Tape& tape = force.tape();
    const int degree = tape.degree(tape.result());
    if (degree == 0)
      return (*this)(tape.operations()[static_cast<std::size_t>(tape.result())].value);
    if (degree != 1) return false;
    const std::vector<double> values = at_points(part.xy, force);
    return linear([&](std::size_t corner) {
      return values[static_cast<std::size_t>(part.triangles[corner])];
    });
  }
};

}  // namespace

bool linear_load(const Triangulation& part, const Force& force, const std::string& region,
                 const LoadContext& context, const std::function<double*()>& room,
                 std::optional<std::span<const std::int32_t>> only) {
  return std::visit(LinearLoad{part, region, context, room, only}, force);
}

Eigen::VectorXd load_vector(const Triangulation& part, const Force& force,
                            const std::string& region, const LoadContext& context) {
  return std::visit(AssembleForce{part, region, context}, force);
}

Eigen::MatrixXd load_vectors(const Triangulation& part, std::span<const std::int32_t> node,
                             std::span<const double* const> arrays) {
  constexpr std::size_t together = 8;
  Eigen::MatrixXd loads(static_cast<Eigen::Index>(part.node_count()),
                        static_cast<Eigen::Index>(arrays.size()));
  const std::size_t rest = arrays.size() % together;
  const std::size_t alone = rest > 2 ? 0 : rest;  // one or two are faster one by one
  const std::size_t in_blocks = arrays.size() - alone;
  integrate_arrays<together>(part, node, arrays.first(in_blocks), 0, loads);
  integrate_arrays<1>(part, node, arrays.last(alone), static_cast<Eigen::Index>(in_blocks), loads);
  return loads;
}

std::vector<double> values_at(std::span<const double> xy, const std::string& text,
                              const std::string& field) {
  return at_points(xy, expression::Function(text, field));
}

bool is_linear(const std::string& text) {
  if (text.empty()) return true;
  const expression::Function function(text, "boundary_value");
  const int degree = function.tape().degree(function.tape().result());
  return degree == 0 || degree == 1;
}

Eigen::VectorXd boundary_values(const Triangulation& part, const std::string& text,
                                std::size_t first, std::size_t count) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  if (text.empty()) return values;
  const expression::Function function(text, "boundary_value");
  const std::vector<double> found =
      at_points(std::span(part.xy).subspan(2 * first, 2 * count), function);
  std::copy(found.begin(), found.end(), values.begin());
  return values;
}

}  // namespace anticrack::fem
