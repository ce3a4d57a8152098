// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/edge_proof.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "stop/stop.hpp"

namespace anticrack::fem {
namespace {

using expression::Enclosure;
using expression::Interval;
using expression::Jet;

constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Of what is unknown of all edges, over int |g|.
constexpr double enough = 1e-8;
constexpr int finest = 48;

Interval along(double middle, double d) {
  return {middle - 0.5 * std::abs(d), middle + 0.5 * std::abs(d)};
}

/// A part of an edge.
struct Half {
  std::size_t edge;
  double from, to;
  int depth;
  EnclosedPiece found;
  double length;
};

}  // namespace

EnclosedPiece enclose(Enclosure& g, const Piece& piece) {
  const auto& [x, y, dx, dy] = piece;
  const Jet jet = g(along(x, dx), along(y, dy), 3);
  EnclosedPiece result;
  result.values = jet.value();
  result.middle = result.mean = jet.value().middle();
  result.radius = result.deviation = jet.value().finite() ? jet.value().radius() : unbounded;
  result.slope = expression::everything;
  if (jet.order < 1) return result;
  const Jet centre = g({x, x}, {y, y}, jet.order - 1);
  const auto& c = jet.of;
  const double value = centre.value().middle(), off = centre.value().radius();
  result.slope = dx * c[1] + dy * c[2];
  const double steep = result.slope.magnitude();
  if (!std::isfinite(steep)) return result;
  result.values = {std::max(result.values.low, value - off - 0.5 * steep),
                   std::min(result.values.high, value + off + 0.5 * steep)};
  result.middle = value;
  result.deviation = off + steep * std::sqrt(1.0 / 12);
  const auto keep = [&](double mean, double radius) {
    if (!(radius < result.radius)) return;
    result.mean = mean;
    result.radius = radius;
  };
  keep(value, off + 0.25 * result.slope.radius());
  const auto second = [&](const Jet& by) {
    return dx * dx * by.of[3] + dx * dy * by.of[4] + dy * dy * by.of[5];
  };
  if (jet.order >= 2) keep(value + second(jet).middle() / 12, off + second(jet).radius() / 12);
  if (jet.order >= 3) {
    const Interval third =
        dx * dx * dx * c[6] + dx * dx * dy * c[7] + dx * dy * dy * c[8] + dy * dy * dy * c[9];
    keep(value + second(centre).middle() / 12,
         off + second(centre).radius() / 12 + third.radius() / 32);
  }
  return result;
}

Proof prove_traction(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                     const expression::Function& g, TractionParts& parts, std::span<double> load,
                     double work) {
  Enclosure enclosure(g.tape());
  std::vector<Half> halves;
  std::priority_queue<std::pair<double, std::size_t>> queue;
  double unknown = 0, absolute = 0;
  std::size_t without = 0;
  const auto point = [&](std::int32_t node) {
    return &part.xy[2 * static_cast<std::size_t>(node)];
  };
  const auto add = [&](Half one) {
    const double *p = point(edges[one.edge][0]), *q = point(edges[one.edge][1]);
    const double dx = q[0] - p[0], dy = q[1] - p[1], middle = 0.5 * (one.from + one.to),
                 share = one.to - one.from;
    one.found =
        enclose(enclosure, {p[0] + middle * dx, p[1] + middle * dy, share * dx, share * dy});
    one.length = share * std::hypot(dx, dy);
    work -= 3 * enclosure.cost();
    const double radius = one.length * one.found.radius;
    if (std::isfinite(radius)) {
      unknown += radius;
      absolute += one.length * std::abs(one.found.mean);
    } else {
      ++without;
    }
    const double resolved = 1e-13 * (std::abs(p[0]) + std::abs(p[1]));
    if (radius > 0 && one.depth < finest && one.length > resolved)
      queue.emplace(radius, halves.size());
    halves.push_back(one);
  };
  for (std::size_t e = 0; e < edges.size(); ++e) add({e, 0, 1, 0, {}, 0});
  std::vector<char> divided(halves.size(), 0);
  while (!queue.empty() && work > 0 && (without > 0 || unknown > enough * absolute)) {
    stop::look("integrating a load");
    const std::size_t i = queue.top().second;
    queue.pop();
    const Half one = halves[i];
    const double radius = one.length * one.found.radius, middle = 0.5 * (one.from + one.to);
    if (std::isfinite(radius)) {
      unknown -= radius;
      absolute -= one.length * std::abs(one.found.mean);
    } else {
      --without;
    }
    add({one.edge, one.from, middle, one.depth + 1, {}, 0});
    add({one.edge, middle, one.to, one.depth + 1, {}, 0});
    divided.resize(halves.size(), 0);
    divided[i] = 1;
  }
  struct Sum {
    double integral = 0, radius = 0, at_second = 0;
  };
  std::vector<Sum> sums(edges.size());
  for (std::size_t i = 0; i < halves.size(); ++i) {
    if (divided[i] != 0) continue;
    const Half& one = halves[i];
    Sum& sum = sums[one.edge];
    sum.integral += one.length * one.found.mean;
    sum.at_second += one.length * one.found.mean * 0.5 * (one.from + one.to);
    sum.radius += one.length * one.found.radius;
  }
  Proof proof;
  parts.unknown.assign(edges.size(), 0);
  parts.beyond.assign(edges.size(), 0);
  double most = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Sum& sum = sums[e];
    double* own = &parts.load[2 * e];
    const double slack = sum.radius + 1e-14 * std::abs(sum.integral);
    const double doubt =
        1e-9 * (std::abs(sum.integral) + absolute / static_cast<double>(edges.size()));
    if (std::abs(own[0] + own[1] - sum.integral) > slack + doubt) {  // samples missed something
      const double moments[] = {sum.integral - sum.at_second, sum.at_second};
      for (std::size_t k = 0; k < 2; ++k) {
        load[static_cast<std::size_t>(edges[e][k])] += moments[k] - own[k];
        own[k] = moments[k];
      }
    }
    parts.unknown[e] = std::abs(own[0] + own[1] - sum.integral) + slack;
    proof.unknown += parts.unknown[e];
    if (!(parts.unknown[e] > most)) continue;
    most = parts.unknown[e];
    const double *p = point(edges[e][0]), *q = point(edges[e][1]);
    proof.worst_x = 0.5 * (p[0] + q[0]);
    proof.worst_y = 0.5 * (p[1] + q[1]);
  }
  for (std::size_t i = 0; i < halves.size(); ++i) {
    if (divided[i] != 0) continue;
    const Half& one = halves[i];
    const double *p = point(edges[one.edge][0]), *q = point(edges[one.edge][1]);
    const double mean = (parts.load[2 * one.edge] + parts.load[2 * one.edge + 1]) /
                        std::hypot(q[0] - p[0], q[1] - p[1]);
    const double off = std::abs(one.found.middle - mean) + one.found.deviation;
    parts.beyond[one.edge] += one.length * off * off;
    proof.absolute += one.length * std::abs(one.found.mean);
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double *p = point(edges[e][0]), *q = point(edges[e][1]);
    parts.beyond[e] = std::sqrt(parts.beyond[e]) +
                      4 * parts.unknown[e] / std::sqrt(std::hypot(q[0] - p[0], q[1] - p[1]));
  }
  return proof;
}

}  // namespace anticrack::fem
