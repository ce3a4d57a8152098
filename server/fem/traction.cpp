// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/traction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fem/load_vector.hpp"
#include "fem/sampler.hpp"
#include "fem/triangle_rules.hpp"

namespace anticrack::fem {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double relative_tolerance = traction_tolerance;
constexpr std::size_t most_evaluations = 1'000'000;
constexpr std::size_t most_cuts = 20'000;
constexpr int most_halvings = 48;

struct Edge {
  std::array<std::int32_t, 2> nodes;
  double x, y, dx, dy, length;
  double inset;  ///< points are drawn in so far, so that an edge is asked for its own side of jumps

  Edge(const Triangulation& part, const std::array<std::int32_t, 2>& ends) : nodes(ends) {
    const double* p = &part.xy[2 * static_cast<std::size_t>(ends[0])];
    const double* q = &part.xy[2 * static_cast<std::size_t>(ends[1])];
    x = p[0];
    y = p[1];
    dx = q[0] - x;
    dy = q[1] - y;
    length = std::hypot(dx, dy);
    inset = std::min(1e-2, 1e-13 + 16 * rounding * (std::abs(x) + std::abs(y) + length) / length);
  }
};

struct Segment {
  std::size_t edge;
  double from, to;
  int depth = 0;
  double whole = 0, at_second = 0, absolute = 0;  ///< int g, int g phi_1, int |g| over the edge
  double before = 0;                              ///< change when it was made
};

class EdgeIntegrator {
 public:
  EdgeIntegrator(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                 const expression::Function& function, const std::stop_token& stop)
      : _sampler(function, stop), _stop(stop) {
    for (const auto& nodes : edges) _edges.emplace_back(part, nodes);
    std::vector<expression::Ref> arguments;
    for (const expression::Switch& one : function.tape().switches()) arguments.push_back(one.of);
    if (!arguments.empty()) {
      _switches.emplace_back(function.tape(), arguments);
    }
  }

  double operator()(Eigen::Ref<Eigen::VectorXd> load) {
    std::vector<Segment> segments;
    for (std::size_t e = 0; e < _edges.size(); ++e) {
      _length += _edges[e].length;
      cut({e, 0, 1}, segments);
    }
    measure(segments);
    for (const Segment& one : segments) _absolute += one.absolute * _edges[one.edge].length;
    while (!segments.empty()) segments = halve(segments, load);
    return _error > 0 ? _error / std::max(_absolute, _settled) : 0;
  }

 private:
  static double between(const Segment& one, double part) {
    return one.from + part * (one.to - one.from);
  }

  /// Arguments of the switches at parts of a segment, drawn in; by part.
  void sample(const Segment& one, std::span<const double> parts) {
    const Edge& edge = _edges[one.edge];
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const double drawn = std::max(edge.inset / (one.to - one.from), 1e-13);
      const double t = between(one, std::clamp(parts[i], drawn, 1 - drawn));
      _x[i] = edge.x + t * edge.dx;
      _y[i] = edge.y + t * edge.dy;
    }
    look_at(_stop);
    _switches.front()(_x.data(), _y.data(), parts.size());
  }

  /// Divides a segment where a switch changes.
  void cut(const Segment& one, std::vector<Segment>& parts) {
    std::vector<Segment> waiting{one};
    while (!waiting.empty()) {
      Segment next = waiting.back();
      waiting.pop_back();
      const double at = change_in(next);
      if (at < 0) {
        parts.push_back({next.edge, next.from, next.to});
      } else {
        ++_cuts;
        ++next.depth;
        waiting.push_back({next.edge, at, next.to, next.depth});
        waiting.push_back({next.edge, next.from, at, next.depth});
      }
    }
  }

  /// Where a switch changes in a segment, or its middle where more than that happens; -1: nowhere.
  double change_in(const Segment& one) {
    if (_switches.empty() || one.depth >= most_halvings || _cuts >= most_cuts ||
        one.to - one.from < 64 * _edges[one.edge].inset) {
      return -1;
    }
    static constexpr std::array<double, 5> parts{0, 0.25, 0.5, 0.75, 1};
    const auto& switches = _sampler.function().tape().switches();
    sample(one, parts);
    for (std::size_t s = 0; s < switches.size(); ++s) {
      const double* g = _switches.front().values(s);
      const double middle = 2 * g[2] - 0.5 * (g[0] + g[4]);
      const double bend = g[0] - 2 * g[2] + g[4];
      const double off = 2 * std::max(std::abs(g[1] - 0.5 * (g[0] + g[2]) + bend / 8),
                                      std::abs(g[3] - 0.5 * (g[2] + g[4]) + bend / 8));
      const double low = std::min({g[0], middle, g[4]}), high = std::max({g[0], middle, g[4]});
      const double zero = 1e-12 * (high - low);
      const double noise = off <= 1e-12 * std::max(std::abs(low), std::abs(high)) ? 0 : off;
      double level = 0;
      if (switches[s].steps) {
        const double first = std::floor(low - noise + zero) + 1,
                     last = std::ceil(high + noise - zero) - 1;
        if (!(first <= last)) continue;
        level = std::floor(0.5 * (first + last));
      } else if (!(low - noise < -zero && high + noise > zero)) {
        continue;
      }
      const bool once =
          (g[0] - level) * (g[4] - level) < 0 && std::abs(bend) + noise < 0.25 * (high - low);
      return once ? bisect(one, s, level) : between(one, 0.5);
    }
    return -1;
  }

  double bisect(const Segment& one, std::size_t s, double level) {
    const auto value = [&](double part) {
      sample(one, {&part, 1});
      return _switches.front().values(s)[0] - level;
    };
    double low = 0, high = 1;
    const bool rising = value(0) < 0;
    while (high - low > 1e-15) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      ((value(middle) < 0) == rising ? low : high) = middle;
    }
    return between(one, 0.5 * (low + high));
  }

  void measure(std::vector<Segment>& segments) {
    constexpr std::size_t at_once = Sampler::block / line_5.size;
    for (std::size_t first = 0; first < segments.size(); first += at_once) {
      const std::size_t count = std::min(at_once, segments.size() - first);
      std::size_t n = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Segment& one = segments[first + i];
        const Edge& edge = _edges[one.edge];
        for (const double part : line_5.at) {
          const double t = between(one, part);
          _x[n] = edge.x + t * edge.dx;
          _y[n++] = edge.y + t * edge.dy;
        }
      }
      const double* g = _sampler(_x.data(), _y.data(), n);
      _sampler.note_peaks(n);
      for (std::size_t i = 0; i < count; ++i) {
        Segment& one = segments[first + i];
        one.whole = one.at_second = one.absolute = 0;
        for (std::size_t k = 0; k < line_5.size; ++k) {
          const std::size_t m = i * line_5.size + k;
          _sampler.function().require_finite(_x[m], _y[m], g[m]);
          const double part = (one.to - one.from) * line_5.weight[k] * g[m];
          one.whole += part;
          one.at_second += part * between(one, line_5.at[k]);
          one.absolute += std::abs(part);
        }
        _trust.push_back(_sampler.trust(i * line_5.size, line_5.size, 1));
      }
    }
  }

  /// Adds what both halves of a segment agree with to the load; returns the halves of the others.
  std::vector<Segment> halve(const std::vector<Segment>& segments,
                             Eigen::Ref<Eigen::VectorXd> load) {
    std::vector<Segment> halves, rest;
    for (const Segment& one : segments) {
      const double middle = between(one, 0.5);
      halves.push_back({one.edge, one.from, middle, one.depth + 1});
      halves.push_back({one.edge, middle, one.to, one.depth + 1});
    }
    _trust.clear();
    measure(halves);
    const double mean = std::max(_absolute, _settled) / _length;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      Segment &low = halves[2 * i], &high = halves[2 * i + 1];
      const double change =
          std::max(std::abs(low.whole + high.whole - segments[i].whole),
                   std::abs(low.at_second + high.at_second - segments[i].at_second));
      const double own = low.absolute + high.absolute;
      const double decay = segments[i].before > 0 ? change / segments[i].before : 0.5;
      const bool converges = change <= 4 * rounding * own || decay <= 0.97;
      const Trust trust = std::max(_trust[2 * i], _trust[2 * i + 1]);
      const bool diverges = !converges && low.depth > 6 && trust >= Trust::singular;
      const double left = change <= 4 * rounding * own ? change
                          : converges                  ? change * decay / (1 - decay)
                          : diverges                   ? infinite
                                                       : 32 * change;
      const double share = std::ldexp(1.0, -low.depth / 2);
      // Where something may be singular, convergence tells.
      const bool sound = trust == Trust::sound ||
                         (trust == Trust::singular && converges && segments[i].before > 0);
      const bool last = low.depth >= most_halvings || _sampler.count() > most_evaluations ||
                        low.to - low.from <= 4 * _edges[low.edge].inset;
      if (last || (sound && left <= 0.5 * relative_tolerance * (mean * share + own)) ||
          (sound && change <= 4 * rounding * own)) {
        const Edge& edge = _edges[low.edge];
        const double whole = low.whole + high.whole, at_second = low.at_second + high.at_second;
        load[edge.nodes[0]] += edge.length * (whole - at_second);
        load[edge.nodes[1]] += edge.length * at_second;
        _settled += edge.length * own;
        _error += sound                         ? edge.length * left
                  : trust == Trust::oscillating ? edge.length * own
                                                : infinite;
      } else {
        low.before = high.before = change;
        rest.push_back(low);
        rest.push_back(high);
      }
    }
    return rest;
  }

  Sampler _sampler;
  std::stop_token _stop;
  std::vector<Edge> _edges;
  std::vector<expression::Evaluator> _switches;  ///< their arguments; none where there are none
  std::vector<Trust> _trust;                     ///< of the segments last measured
  std::array<double, Sampler::block> _x{}, _y{};
  std::size_t _cuts = 0;
  double _length = 0, _absolute = 0, _settled = 0, _error = 0;
};

}  // namespace

double add_traction(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                    const std::string& traction, Eigen::Ref<Eigen::VectorXd> load,
                    const std::stop_token& stop) {
  const expression::Function function(traction, "traction");
  return EdgeIntegrator(part, edges, function, stop)(load);
}

}  // namespace anticrack::fem
