// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/traction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fem/edge_proof.hpp"
#include "fem/load_vector.hpp"
#include "fem/sampler.hpp"
#include "fem/triangle_rules.hpp"

namespace anticrack::fem {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double infinite = std::numeric_limits<double>::infinity();
/// At most this many halvings enclose a jump.
constexpr int most_halvings = 44;
/// Limit of the work, and the work of a point besides its evaluation, roughly in ns.
constexpr double most_work = 2e7, overhead = 20;

struct Edge {
  std::array<std::int32_t, 2> nodes;
  double x, y, dx, dy, length;
  double resolved;  ///< shorter parts are too close to rounding

  Edge(const Triangulation& part, const std::array<std::int32_t, 2>& ends) : nodes(ends) {
    const double* p = &part.xy[2 * static_cast<std::size_t>(ends[0])];
    const double* q = &part.xy[2 * static_cast<std::size_t>(ends[1])];
    x = p[0];
    y = p[1];
    dx = q[0] - x;
    dy = q[1] - y;
    length = std::hypot(dx, dy);
    resolved = 2048 * rounding * (std::abs(x) + std::abs(y) + length) / length;
  }
};

struct Segment {
  std::size_t edge;
  double from, to;
  int depth = 0;
  /// int g, int g phi_1, int |g| over the edge, by its length
  double whole = 0, at_second = 0, absolute = 0;
  double before = 0, first = 0;  ///< change when it was made, and first change of its edge
  Trust trust = Trust::sound;
};

class EdgeIntegrator {
 public:
  EdgeIntegrator(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                 const expression::Function& function)
      : _sampler(function, Sampler::Jumps::watched),
        _most_evaluations(static_cast<std::size_t>(most_work / (overhead + _sampler.cost()))) {
    for (const auto& nodes : edges) _edges.emplace_back(part, nodes);
  }

  double operator()(Eigen::Ref<Eigen::VectorXd> load, TractionParts& parts) {
    parts.load.assign(2 * _edges.size(), 0);
    _parts = &parts;
    std::vector<Segment> segments;
    for (std::size_t e = 0; e < _edges.size(); ++e) {
      _length += _edges[e].length;
      segments.push_back({e, 0, 1});
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
        one.trust = _sampler.trust(i * line_5.size, line_5.size, 1);
      }
    }
  }

  /// Halves segments; adds the halves that are accurate enough to the load, returns the others.
  std::vector<Segment> halve(const std::vector<Segment>& segments,
                             Eigen::Ref<Eigen::VectorXd> load) {
    std::vector<Segment> halves, rest;
    for (const Segment& one : segments) {
      const double middle = between(one, 0.5);
      halves.push_back({one.edge, one.from, middle, one.depth + 1});
      halves.push_back({one.edge, middle, one.to, one.depth + 1});
    }
    measure(halves);
    const double mean = std::max(_absolute, _settled) / _length;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      Segment &low = halves[2 * i], &high = halves[2 * i + 1];
      const double whole = low.whole + high.whole, at_second = low.at_second + high.at_second,
                   absolute = low.absolute + high.absolute;
      const double change = std::max(std::abs(whole - segments[i].whole),
                                     std::abs(at_second - segments[i].at_second));
      Trust trust = std::max(low.trust, high.trust);
      // Further changes are expected to decay like the last one. At a singularity, where samples
      // are near or far by chance, they are expected to decay like all changes so far.
      const double before = segments[i].before, first = segments[i].first;
      double decay = before > 0 ? change / before : 0.5;
      if (trust >= Trust::singular && first > 0)
        decay = std::pow(change / first, 1.0 / (low.depth - 1));
      const bool exact = change <= 4 * rounding * absolute, converges = exact || decay <= 0.97;
      double left = exact ? change : converges ? change * decay / (1 - decay) : 32 * change;
      if (!converges && low.depth > 6 && trust >= Trust::singular) left = infinite;
      if (trust == Trust::singular && converges && before > 0) trust = Trust::sound;
      const double share = std::ldexp(1.0, -low.depth / 2);
      const Edge& edge = _edges[low.edge];
      const bool last = low.depth >= most_halvings || _sampler.count() > _most_evaluations ||
                        low.to - low.from <= edge.resolved;
      if (last || (trust == Trust::sound &&
                   (exact || left <= 0.5 * traction_tolerance * (mean * share + absolute)))) {
        load[edge.nodes[0]] += edge.length * (whole - at_second);
        load[edge.nodes[1]] += edge.length * at_second;
        _parts->load[2 * low.edge] += edge.length * (whole - at_second);
        _parts->load[2 * low.edge + 1] += edge.length * at_second;
        _settled += edge.length * absolute;
        _error += trust == Trust::sound        ? edge.length * left
                  : trust == Trust::unresolved ? edge.length * absolute
                                               : infinite;
      } else {
        low.before = high.before = change;
        low.first = high.first = low.depth == 1 ? change : first;
        rest.push_back(low);
        rest.push_back(high);
      }
    }
    return rest;
  }

  Sampler _sampler;
  std::size_t _most_evaluations;
  std::vector<Edge> _edges;
  std::array<double, Sampler::block> _x{}, _y{};
  TractionParts* _parts = nullptr;
  double _length = 0, _absolute = 0, _settled = 0, _error = 0;
};

}  // namespace

TractionReport add_traction(const Triangulation& part,
                            std::span<const std::array<std::int32_t, 2>> edges,
                            const std::string& traction, Eigen::Ref<Eigen::VectorXd> load,
                            TractionParts* parts) {
  const expression::Function function(traction, "traction");
  TractionParts own;
  if (parts == nullptr) parts = &own;
  TractionReport report;
  report.relative_error_estimate = EdgeIntegrator(part, edges, function)(load, *parts);
  report.proof = prove_traction(part, edges, function, *parts,
                                {load.data(), static_cast<std::size_t>(load.size())}, most_work);
  return report;
}

}  // namespace anticrack::fem
