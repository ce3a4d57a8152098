// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptive_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "fem/cut_triangle.hpp"
#include "fem/sampled_triangle.hpp"
#include "fem/smooth_triangle.hpp"

namespace anticrack::fem {
namespace {

constexpr std::size_t points_per_sample = 15;

/// One of the two triangles at an edge.
struct EdgeSide {
  std::array<std::int32_t, 2> nodes;  ///< ascending
  std::size_t triangle;
  std::size_t edge;  ///< from corner `edge` to the next
};

class LoadIntegrator {
 public:
  LoadIntegrator(std::span<const double> xy, std::span<const std::int32_t> triangles,
                 const ScalarField& f, const IntegrationLimits& limits, std::stop_token stop)
      : _xy(xy),
        _triangles(triangles),
        _limits(limits),
        _field(f, points_per_sample * (triangles.size() / 3) + limits.evaluations, std::move(stop)),
        _parts(triangles.size() / 3),
        _swept(_parts.size(), 0) {}

  IntegrationReport operator()(std::span<double> load) {
    double whole = 0;
    for (std::size_t t = 0; t < _parts.size(); ++t) {
      const Triangle triangle = corners(t);
      if (!(area(triangle) > 0)) {  // as small as coordinates resolve
        _swept[t] = 1;
        continue;
      }
      _parts[t] = sample_triangle(triangle, _field);
      _absolute += _parts[t].absolute;
      whole += area(triangle);
    }
    _mean = whole > 0 ? _absolute / whole : 0;
    improve();
    follow_cuts();
    spend_rest();
    return collect(load);
  }

 private:
  Triangle corners(std::size_t t) const {
    Triangle result{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto node = static_cast<std::size_t>(_triangles[3 * t + i]);
      result[i] = {_xy[2 * node], _xy[2 * node + 1]};
    }
    return result;
  }

  /// Error that triangle t may have; see integrate_load.
  double tolerance(std::size_t t, const Triangle& triangle) const {
    const double size = area(triangle);
    const double level = _mean + _parts[t].absolute / size;
    const double rounding = 64 * std::numeric_limits<double>::epsilon() * magnitude(triangle);
    return level * (0.5 * _limits.relative_tolerance * size + rounding * longest_edge(triangle));
  }

  void improve() {
    for (std::size_t t = 0; t < _parts.size(); ++t) {
      const Triangle triangle = corners(t);
      const double allowed = tolerance(t, triangle);
      if (!(_parts[t].error > allowed) || _field.spent()) {
        continue;
      }
      if (!refine_smooth_triangle(triangle, allowed, _parts[t], _field)) {
        sweep(t, triangle, allowed, _limits.evaluations_per_triangle);
      }
    }
  }

  void sweep(std::size_t t, const Triangle& triangle, double allowed, std::size_t evaluations) {
    _field.allow(evaluations);
    std::array<EdgeBreaks, 3> edges;
    for (std::size_t i = 0; i < 3; ++i) {
      edges[i] = scan_edge(triangle, i, 0.1 * allowed / area(triangle), _field);
    }
    // No finer than jumps are located, where the samples have seen too little of f.
    const double attainable = 1e-13 * _field.peak() * area(triangle);
    const CutTriangle found =
        integrate_cut_triangle(triangle, edges, std::max(allowed, attainable), _field);
    _parts[t].nodal = found.nodal;
    _parts[t].error = found.error;
    if (found.cut && _swept[t] == 0) {
      _cut.push_back(t);
    }
    _swept[t] = 1;
  }

  /// Sides of the edges, the two of an edge next to each other.
  std::vector<EdgeSide> edge_sides() const {
    std::vector<EdgeSide> sides;
    sides.reserve(_triangles.size());
    for (std::size_t t = 0; t < _parts.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = _triangles[3 * t + i], b = _triangles[3 * t + (i + 1) % 3];
        sides.push_back({{std::min(a, b), std::max(a, b)}, t, i});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
      return a.nodes != b.nodes ? a.nodes < b.nodes : a.triangle < b.triangle;
    });
    return sides;
  }

  void follow_cuts() {
    if (_cut.empty()) {
      return;
    }
    const std::vector<EdgeSide> sides = edge_sides();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const bool paired = (i > 0 && sides[i - 1].nodes == sides[i].nodes) ||
                          (i + 1 < sides.size() && sides[i + 1].nodes == sides[i].nodes);
      if (!paired) {
        sweep_if_cut(sides[i]);
      }
    }
    for (std::size_t next = 0; next < _cut.size(); ++next) {  // grows as it goes
      const std::size_t t = _cut[next];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = _triangles[3 * t + i], b = _triangles[3 * t + (i + 1) % 3];
        const std::array<std::int32_t, 2> nodes{std::min(a, b), std::max(a, b)};
        for (auto side = std::lower_bound(
                 sides.begin(), sides.end(), nodes,
                 [](const EdgeSide&one, const auto&wanted) { return one.nodes < wanted; });
             side != sides.end() && side->nodes == nodes; ++side) {
          sweep_if_cut(*side);
        }
      }
    }
  }

  void sweep_if_cut(const EdgeSide& side) {
    if (_swept[side.triangle] != 0 || _field.spent()) {
      return;
    }
    const Triangle triangle = corners(side.triangle);
    const double allowed = tolerance(side.triangle, triangle);
    _field.allow(_limits.evaluations_per_triangle);
    const EdgeBreaks found = scan_edge(triangle, side.edge, 0.1 * allowed / area(triangle), _field);
    if (!found.jumps.empty() || !found.kinks.empty()) {
      sweep(side.triangle, triangle, allowed, _limits.evaluations_per_triangle);
    }
  }

  /// Few triangles need many evaluations, e.g. where a jump turns back: the worst first.
  void spend_rest() {
    std::vector<std::size_t> unfinished;
    for (std::size_t t = 0; t < _parts.size(); ++t) {
      if (_swept[t] != 0 && _parts[t].error > tolerance(t, corners(t))) {
        unfinished.push_back(t);
      }
    }
    std::stable_sort(unfinished.begin(), unfinished.end(), [this](std::size_t a, std::size_t b) {
      return _parts[a].error > _parts[b].error;
    });
    for (const std::size_t t : unfinished) {
      if (_field.spent()) {
        return;
      }
      const Triangle triangle = corners(t);
      sweep(t, triangle, tolerance(t, triangle), _limits.evaluations / 16);
    }
  }

  IntegrationReport collect(std::span<double> load) const {
    std::fill(load.begin(), load.end(), 0.0);
    IntegrationReport report;
    report.evaluations = _field.count();
    report.cut_triangles = _cut.size();
    // The samples may have met next to nothing of f, and the sweeps all of it.
    double whole = 0;
    for (const SampledTriangle& part : _parts) {
      whole += part.nodal[0] + part.nodal[1] + part.nodal[2];
    }
    const double absolute = std::max(_absolute, std::abs(whole));
    for (std::size_t t = 0; t < _parts.size(); ++t) {
      report.relative_error_estimate += absolute > 0 ? _parts[t].error / absolute : 0;
      for (std::size_t i = 0; i < 3; ++i) {
        load[static_cast<std::size_t>(_triangles[3 * t + i])] += _parts[t].nodal[i];
      }
    }
    return report;
  }

  std::span<const double> _xy;
  std::span<const std::int32_t> _triangles;
  IntegrationLimits _limits;
  CountedField _field;
  std::vector<SampledTriangle> _parts;
  std::vector<char> _swept;  ///< 1: its edges need no look from the neighbours
  std::vector<std::size_t> _cut;
  double _absolute = 0;  ///< int |f|, from the samples
  double _mean = 0;      ///< of |f|
};

}  // namespace

IntegrationReport integrate_load(std::span<const double> xy,
                                 std::span<const std::int32_t> triangles, const ScalarField& f,
                                 std::span<double> load, const IntegrationLimits& limits,
                                 std::stop_token stop) {
  return LoadIntegrator(xy, triangles, f, limits, std::move(stop))(load);
}

}  // namespace anticrack::fem
