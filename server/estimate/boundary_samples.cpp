// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/boundary_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "base/at.hpp"
#include "estimate/edge_polynomial.hpp"
#include "expression/enclosure.hpp"
#include "expression/function.hpp"
#include "fem/load_vector.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

using expression::Enclosure;
using expression::Jet;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr const char* field = "boundary_value";

/// Greatest distance of the values in an interval from `value`.
double farthest(const expression::Interval& from, double value) {
  return std::max(std::abs(from.low - value), std::abs(from.high - value));
}

/// Half of an edge, which begins or ends in a node.
struct Half {
  Vector node, along;
  bool from_node;  ///< else it ends in the node
};

/// g as a function of t = -1/2 ... 1/2 on half an edge, and the polynomial p through its samples.
class Line {
 public:
  Line(Enclosure& g, double in_node, const Half& half, const EdgePolynomial& p)
      : _g(g),
        _in_node(in_node),
        _node(half.node),
        _along(half.along),
        _at_node(half.from_node ? -0.5 : 0.5),
        _p(p) {}

  /// >= int (g' - p')^2 dt. The piece with the greatest bound is halved until all are small
  /// compared with the integral for p and its chord. Infinite unless g is proved to be continuous,
  /// also in the node.
  double missed() const {
    if (!meets_node()) return infinite;
    const double chord = _p(0.5) - _p(-0.5);
    double bend = 0, size = 0;
    for (const double t : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      bend = std::max(bend, std::abs(_p(t, 1) - chord));
      size = std::max(size, std::abs(_p(t)));
    }
    const double enough = 1e-2 * bend + 1e-12 * size;
    const double smooth = by_interpolation();
    if (smooth <= enough * enough) return smooth;
    std::priority_queue<Piece> pieces;
    pieces.push(piece(-0.5, 0.5));
    constexpr std::size_t most = 60;
    for (std::size_t i = 0; i < most && pieces.top().missed > enough * enough / 16; ++i) {
      const Piece one = pieces.top();
      const double middle = 0.5 * (one.from + one.to);
      if (!(one.from < middle && middle < one.to)) break;
      pieces.pop();
      pieces.push(piece(one.from, middle));
      pieces.push(piece(middle, one.to));
    }
    double sum = 0;
    for (; !pieces.empty(); pieces.pop()) sum += pieces.top().missed;
    return std::min(smooth, sum);
  }

 private:
  struct Piece {
    double missed, from, to;
    bool operator<(const Piece& other) const { return missed < other.missed; }
  };

  /// Ends are rounded outwards, so that a jump at the end of a piece lies in both pieces. The node
  /// is not rounded, as the edge lies on one side of it.
  expression::Interval box(std::size_t d, double from, double to) const {
    const auto place = [&](double t) { return _node[d] + (t - _at_node) * _along[d]; };
    const double a = place(from), b = place(to);
    if (_along[d] == 0) return {a, a};
    expression::Interval result = expression::outward(std::min(a, b), std::max(a, b));
    if (from == _at_node || to == _at_node)
      (_node[d] < place(-_at_node) ? result.low : result.high) = _node[d];
    return result;
  }
  /// Whether the limit of g in the node is its value there, which u_h takes.
  bool meets_node() const {
    constexpr double near = 1e-9, rounding = 1e-12;
    const double to = _at_node * (1 - near);
    const Jet jet = enclose(std::min(_at_node, to), std::max(_at_node, to), 1);
    const double off = rounding * jet.value().magnitude();
    return jet.order >= 1 && jet.value().low - off <= _in_node &&
           _in_node <= jet.value().high + off;
  }
  Jet enclose(double from, double to, int order) const {
    return _g(box(0, from, to), box(1, from, to), order);
  }
  /// The coefficient of t^degree.
  expression::Interval along(const Jet& jet, int degree) const {
    expression::Interval sum;
    const int first = degree * (degree + 1) / 2;
    for (int j = 0; j <= degree; ++j) {
      const double factor = std::pow(_along[0], degree - j) * std::pow(_along[1], j);
      sum = sum + factor * jet.of[static_cast<std::size_t>(first) + static_cast<std::size_t>(j)];
    }
    return sum;
  }

  /// A bound by interpolation, which is exact for the Taylor polynomial of degree k < 5 with the
  /// midpoint of the k-th coefficient; the rest is r <= radius |t|^k, r' <= radius k |t|^(k-1).
  double by_interpolation() const {
    const Jet jet = enclose(-0.5, 0.5, Jet::most);
    const double steepest = EdgePolynomial::steepest();
    double least = infinite;
    for (int k = 1; k <= jet.order; ++k) {
      const double off = along(jet, k).radius() * std::pow(0.5, k) * (2 * k + steepest);
      if (off < least) least = off;
    }
    return least * least;
  }

  /// A bound on a piece, from the values of g', or from g' in the middle and the values of g''.
  Piece piece(double from, double to) const {
    const double middle = 0.5 * (from + to), reach = 0.5 * (to - from);
    const double slope = _p(middle, 1), bend = _p(middle, 2);
    const double bend_varies = reach * (std::abs(_p(middle, 3)) + 0.5 * reach * std::abs(_p(0, 4)));
    const Jet jet = enclose(from, to, 2);
    double off = infinite;
    if (jet.order >= 1) {
      const double by_values =
          farthest(along(jet, 1), slope) + reach * (std::abs(bend) + bend_varies);
      if (by_values < off) off = by_values;
    }
    if (jet.order >= 2) {
      const double by_middle = farthest(along(enclose(middle, middle, 1), 1), slope) +
                               reach * (farthest(2 * along(jet, 2), bend) + bend_varies);
      if (by_middle < off) off = by_middle;
    }
    return {off * off * (to - from), from, to};
  }

  Enclosure& _g;
  const double _in_node;  // g in the node
  const Vector _node, _along;
  const double _at_node;
  const EdgePolynomial& _p;
};

}  // namespace

bool has_boundary_value(const Face& face) {
  return face.condition == Condition::free && face.inclusion < 0;
}

std::array<std::size_t, 3> corners_of(const Face& face) {
  const std::size_t t = at(face.side / 3), i = at(face.side % 3);
  return {3 * t + (i + 1) % 3, 3 * t + (i + 2) % 3, 3 * t + i};
}

BoundarySamples boundary_samples(const CutMesh& cut, const std::string& text) {
  std::vector<Half> lines;
  std::vector<double> xy;
  for (const Face& face : cut.faces) {
    if (!has_boundary_value(face)) continue;
    const auto corners = corners_of(face);
    const Vector &p = cut.at[at(cut.copy[corners[0]])], &q = cut.at[at(cut.copy[corners[1]])];
    const Vector along{0.5 * (q[0] - p[0]), 0.5 * (q[1] - p[1])};
    for (const bool first : {true, false}) {
      lines.push_back({first ? p : q, along, first});
      for (const double t : fem::line_5.at)
        for (std::size_t d = 0; d < 2; ++d)
          xy.push_back(first ? p[d] + t * along[d] : q[d] - (1 - t) * along[d]);
    }
  }
  BoundarySamples result{fem::values_at(xy, text, field), {}};
  const expression::Function function(text, field);
  Enclosure g(function.tape());
  EdgePolynomial::Values values{};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    stop::look_at_turn<64>(i, "lifting the boundary");
    std::copy_n(&result.values[i * values.size()], values.size(), values.begin());
    const double in_node = function(lines[i].node[0], lines[i].node[1]);
    const double missed = Line(g, in_node, lines[i], EdgePolynomial(values)).missed();
    if (i % BoundarySamples::halves == 0) result.unknown.push_back(0);
    // The derivative by s is twice that by t; dt is twice ds.
    result.unknown.back() += BoundarySamples::halves * missed;
  }
  for (double& one : result.unknown) one = std::sqrt(one);
  return result;
}

}  // namespace anticrack::estimate
