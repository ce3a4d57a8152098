// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/traction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fem/expression.hpp"
#include "fem/piecewise_quadrature.hpp"

namespace anticrack::fem {
namespace {

constexpr double relative_tolerance = 1e-10;
constexpr std::size_t evaluations_of_edge = 20'000;
constexpr std::size_t evaluations_of_all = 10'000'000;
constexpr std::size_t panels = 8;

/// Points at t in [0, 1], drawn in from both ends so that an edge is asked for its own side of a
/// jump in its node.
class Edge {
 public:
  Edge(const Triangulation& part, const std::array<std::int32_t, 2>& nodes)
      : _x(at(part, nodes[0], 0)),
        _y(at(part, nodes[0], 1)),
        _dx(at(part, nodes[1], 0) - _x),
        _dy(at(part, nodes[1], 1) - _y),
        _length(std::hypot(_dx, _dy)) {
    const double rounding =
        std::numeric_limits<double>::epsilon() * (std::abs(_x) + std::abs(_y) + _length) / _length;
    _resolution = std::max(1e-13, 4 * rounding);
    _inset = std::min(std::max(1e-13, 16 * rounding), 1e-2);
  }

  double value(CountedField& field, double t) const {
    const double drawn = _inset + t * (1 - 2 * _inset);
    return field(_x + drawn * _dx, _y + drawn * _dy);
  }
  double length() const { return _length; }
  double resolution() const { return _resolution; }

 private:
  static double at(const Triangulation& part, std::int32_t node, std::size_t axis) {
    return part.xy[2 * static_cast<std::size_t>(node) + axis];
  }

  double _x;
  double _y;
  double _dx;
  double _dy;
  double _length;
  double _resolution = 0;
  double _inset = 0;
};

/// Mean of |g| on an edge.
double level(const Edge& edge, CountedField& field) {
  double mean = 0;
  for (std::size_t i = 0; i < lobatto_4_7.nodes.size(); ++i) {
    mean +=
        0.5 * lobatto_4_7.fine[i] * std::abs(edge.value(field, 0.5 + 0.5 * lobatto_4_7.nodes[i]));
  }
  return mean;
}

}  // namespace

double add_traction(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                    const std::string& traction, Eigen::Ref<Eigen::VectorXd> load,
                    const std::stop_token& stop) {
  ExpressionFunction function(traction, "traction");
  const ScalarField expression = [&function](double x, double y) { return function(x, y); };
  // Every edge has the points of its first panels, whatever the others took.
  CountedField field(expression, evaluations_of_all + 7 * (panels + 1) * edges.size(), stop);
  std::vector<double> levels;
  levels.reserve(edges.size());
  double absolute = 0, length = 0;
  for (const std::array<std::int32_t, 2>& nodes : edges) {
    const Edge edge(part, nodes);
    levels.push_back(level(edge, field));
    absolute += levels.back() * edge.length();
    length += edge.length();
  }
  const double mean = length > 0 ? absolute / length : 0;

  std::array<double, panels + 1> ends{};
  for (std::size_t i = 0; i <= panels; ++i) {
    ends[i] = static_cast<double>(i) / panels;
  }
  double error = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Edge edge(part, edges[e]);
    const auto along = [&](double t) { return Reading<1>{{edge.value(field, t)}, 0}; };
    field.allow(evaluations_of_edge);
    const PiecewiseIntegral<1> found = PiecewiseQuadrature<1, decltype(along)>(
        along, field, {0.5 * relative_tolerance * (mean + levels[e]), edge.resolution()})(ends);
    const double at_second = found.first[0], whole = found.zeroth[0];
    load[edges[e][0]] += edge.length() * (whole - at_second);
    load[edges[e][1]] += edge.length() * at_second;
    error += edge.length() * found.error;
    absolute = std::max(absolute, edge.length() * std::abs(whole));
  }
  return absolute > 0 ? error / absolute : 0;
}

}  // namespace anticrack::fem
