// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/continuation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "base/at.hpp"
#include "ddm/elimination_order.hpp"
#include "ddm/subdomain_factor.hpp"
#include "errors/errors.hpp"
#include "estimate/load_balance.hpp"
#include "mesh/edges.hpp"
#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr const char* continuing = "continuing functions out of a stiff part";

constexpr std::int32_t none = -1;
constexpr std::size_t following(std::size_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
constexpr std::size_t preceding(std::size_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}
double square(const Vector& a) { return dot(a, a); }
double cross(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }
Vector along(const Vector& a, double by, const Vector& b) {
  return {a[0] + by * b[0], a[1] + by * b[1]};
}

bool is_boundary_value(const Face& face) {
  return face.condition == Condition::free && face.inclusion < 0;
}

/// The uncut triangles, numbered as those of the CutMesh.
class Triangulation {
 public:
  Triangulation(const mesh::Mesh& mesh, const CutMesh& of) : cut(of), count(mesh.node_count()) {
    node.reserve(cut.copy.size());
    for (const std::int32_t triangle : cut.triangle)
      for (std::size_t i = 0; i < 3; ++i) node.push_back(mesh.triangles[3 * at(triangle) + i]);
    across.assign(node.size(), none);
    mesh::EdgeTable(node).each([&](std::span<const mesh::EdgeUse> uses) {
      if (uses.size() != 2) return;
      const std::size_t a = side_of(uses[0]), b = side_of(uses[1]);
      across[a] = static_cast<std::int32_t>(b);
      across[b] = static_cast<std::int32_t>(a);
    });
    face.assign(node.size(), none);
    for (std::size_t f = 0; f < cut.faces.size(); ++f)
      face[at(cut.faces[f].side)] = static_cast<std::int32_t>(f);
  }

  const Vector& place(std::size_t corner) const { return cut.at[at(cut.copy[corner])]; }
  /// The side opposite to a corner, counterclockwise.
  Vector side(std::size_t corner) const {
    return along(place(preceding(corner)), -1, place(following(corner)));
  }
  double area(std::size_t t) const { return cross(side(3 * t), side(3 * t + 1)) / 2; }
  const Face* face_of(std::size_t of_side) const {
    return face[of_side] < 0 ? nullptr : &cut.faces[at(face[of_side])];
  }

  const CutMesh& cut;
  const std::size_t count;           // of nodes
  std::vector<std::int32_t> node;    // per corner
  std::vector<std::int32_t> across;  // per side: that of the neighbour, or none
  std::vector<std::int32_t> face;    // per side: index into CutMesh::faces, or none

 private:
  std::size_t side_of(const mesh::EdgeUse& use) const {
    const std::size_t first = 3 * at(use.triangle);
    return preceding(
        static_cast<std::size_t>(std::find(&node[first], &node[first] + 3, use.from) - &node[0]));
  }
};

/// A number a little above the largest w'A w / w'B w, A without what it has of the columns of Z, on
/// which B is 0. Negative if Cholesky's factor proves none.
double largest_ratio(Eigen::MatrixXd a, Eigen::MatrixXd b, const Eigen::MatrixXd& z) {
  if (z.cols() > 0) {
    const Eigen::MatrixXd of_z = a * z;
    a -= of_z * (z.transpose() * of_z).ldlt().solve(of_z.transpose());
    b += b.trace() / static_cast<double>(b.rows()) * z *
         z.colwise().squaredNorm().cwiseInverse().asDiagonal() * z.transpose();
  }
  a = (0.5 * (a + a.transpose())).eval();
  b = (0.5 * (b + b.transpose())).eval();
  const Eigen::LLT<Eigen::MatrixXd> factor(b);
  if (factor.info() != Eigen::Success) return -1;
  // A few powers find it nearly; a factor says whether a number is above it.
  constexpr int powers = 40, most_tries = 30;
  constexpr double above = 1.02, more = 1.1;
  double ratio = 0;
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(b.rows(), 1, 2);
  for (int k = 0; k < powers; ++k) {
    stop::look(continuing);
    const Eigen::VectorXd of_x = a * x;
    if (!(of_x.norm() > 0)) break;
    ratio = std::max(ratio, x.dot(of_x) / x.dot(b * x));
    x = factor.solve(of_x / of_x.norm());
  }
  ratio = above * std::max(ratio, 1e-3);  // well above rounding
  for (int k = 0; k < most_tries; ++k, ratio *= more) {
    stop::look(continuing);
    if (Eigen::LLT<Eigen::MatrixXd>(ratio * b - a).info() == Eigen::Success) return ratio;
  }
  return -1;
}

/// A sparse symmetric matrix whose last unknowns are the trace.
class Matrix {
 public:
  explicit Matrix(std::size_t unknowns) : _places(2 * unknowns) {}
  void add(std::int32_t i, std::int32_t j, double value) {
    if (i >= j && j >= 0) _entries.emplace_back(i, j, value);
  }
  void put(std::int32_t i, const Vector& place) {
    if (i >= 0) std::ranges::copy(place, &_places[2 * at(i)]);
  }
  Eigen::MatrixXd schur(std::size_t trace) const {
    const auto all = static_cast<Eigen::Index>(_places.size() / 2),
               interior = all - static_cast<Eigen::Index>(trace);
    Eigen::SparseMatrix<double> matrix(all, all);
    matrix.setFromTriplets(_entries.begin(), _entries.end());
    if (interior == 0) return Eigen::MatrixXd(matrix).selfadjointView<Eigen::Lower>();
    return ddm::SubdomainFactor(matrix, interior, ddm::elimination_order(matrix, interior, _places))
        .take_schur();
  }

 private:
  std::vector<double> _places;
  std::vector<Eigen::Triplet<double>> _entries;
};

/// Triangles of one kind about a node of Gamma, without a gap.
struct Run {
  std::vector<std::size_t> corner;  // counterclockwise
  std::vector<double> until;        // part of the run's angle up to the end of each
  std::size_t before() const { return preceding(corner.front()); }  // its first spoke, as a side
  std::size_t after() const { return following(corner.back()); }    // and its last one
};

class Continuation {
 public:
  Continuation(const Triangulation& in, const std::vector<char>& stiff)
      : _in(in), _stiff(stiff), _trace(in.node.size(), none), _node(in.count, none) {}

  /// C; negative if none is known.
  double operator()() {
    if (!find_interface() || !find_parts() || !find_fans()) return -1;
    double local = 0;
    for (const double one : _local) local = std::max(local, one);
    const double whole =
        largest_ratio(_means.transpose() * of_soft() * _means, of_stiff(), _islands);
    if (!(whole >= 0)) return -1;
    return std::sqrt(whole) + std::sqrt(_stretch) + std::sqrt(local);
  }

 private:
  static constexpr std::size_t most_edges = 1000, most_stiff = 200'000;

  bool in_stiff(std::size_t side) const { return _stiff[side / 3] != 0; }
  bool on_interface(std::size_t side) const {
    return _in.across[side] >= 0 && in_stiff(side) != in_stiff(at(_in.across[side]));
  }

  bool find_interface() {
    std::int32_t edges = 0;
    for (std::size_t side = 0; side < _trace.size(); ++side) {
      if (!in_stiff(side) || !on_interface(side)) continue;
      const Face* face = _in.face_of(side);
      if (face != nullptr && face->condition == Condition::pressed) return false;
      _trace[side] = edges++;
      for (const std::size_t corner : {following(side), preceding(side)}) {
        std::int32_t& node = _node[at(_in.node[corner])];
        if (node < 0) node = _nodes++;
      }
    }
    _edges = at(edges);
    const auto all = static_cast<std::size_t>(std::ranges::count(_stiff, 1));
    if (edges == 0 || _edges > most_edges || all > most_stiff) return false;
    _means = Eigen::MatrixXd::Zero(_nodes, edges);
    _local.assign(_stiff.size(), 0);
    return true;
  }

  /// Connected pieces of the stiff part that Gamma bounds, and which of them are islands; where
  /// bodies lie.
  bool find_parts() {
    _piece.assign(_stiff.size(), none);
    std::vector<char> held;
    std::vector<std::size_t> queue;
    for (std::size_t side = 0; side < _trace.size(); ++side) {
      if (_trace[side] < 0 || _piece[side / 3] >= 0) continue;
      const auto piece = static_cast<std::int32_t>(held.size());
      held.push_back(0);
      queue.assign(1, side / 3);
      _piece[side / 3] = piece;
      while (!queue.empty()) {
        const std::size_t t = queue.back();
        queue.pop_back();
        for (std::size_t own = 3 * t; own < 3 * t + 3; ++own) {
          const Face* face = _in.face_of(own);
          if (face != nullptr && is_boundary_value(*face)) held.back() = 1;
          if (_in.across[own] < 0 || face != nullptr) continue;
          const std::size_t beyond = at(_in.across[own]) / 3;
          if (_stiff[beyond] == 0 || _piece[beyond] >= 0) continue;
          _piece[beyond] = piece;
          queue.push_back(beyond);
        }
      }
    }
    // Per body: faces off the stiff part, others, and the piece of these.
    constexpr std::int32_t several = -2, unseen = -3;
    const Ways& ways = _in.cut.ways;
    std::vector<char> outside(ways.bodies.size(), 0), inside(outside);
    std::vector<std::int32_t> piece_of(ways.bodies.size(), unseen);
    std::vector<char> bound(held.size(), 0);  // tied to another piece by a face or a body, or held
    for (const Face& face : _in.cut.faces) {
      if (face.other < 0) continue;
      const std::size_t side = at(face.side), other = at(_in.cut.faces[at(face.other)].side);
      const std::int32_t own = _piece[side / 3];
      if (own >= 0 && in_stiff(other) && _piece[other / 3] != own) bound[at(own)] = 1;
      if (face.inclusion < 0) continue;
      const auto body = at(ways.of[at(face.inclusion)]);
      if (!in_stiff(side)) {
        (in_stiff(other) ? inside : outside)[body] = 1;
        continue;
      }
      inside[body] = 1;
      piece_of[body] = piece_of[body] == unseen || piece_of[body] == own ? own : several;
    }
    for (std::size_t b = 0; b < outside.size(); ++b)
      if (outside[b] != 0 && inside[b] != 0) return false;
    for (const Face& face : _in.cut.faces) {
      const std::int32_t own = _piece[at(face.side / 3)];
      if (own < 0 || face.inclusion < 0) continue;
      const auto body = at(ways.of[at(face.inclusion)]);
      if (piece_of[body] == several || ways.bodies[body].held) bound[at(own)] = 1;
    }
    std::vector<std::int32_t> column(held.size(), none);
    std::int32_t islands = 0;
    for (std::size_t piece = 0; piece < held.size(); ++piece) {
      if (held[piece] != 0) continue;
      if (bound[piece] != 0) return false;
      column[piece] = islands++;
    }
    _islands = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(_edges), islands);
    for (std::size_t side = 0; side < _trace.size(); ++side)
      if (_trace[side] >= 0 && column[at(_piece[side / 3])] >= 0)
        _islands(_trace[side], column[at(_piece[side / 3])]) = 1;
    return true;
  }

  bool find_fans() {
    std::vector<std::vector<std::size_t>> around(at(_nodes));
    for (std::size_t corner = 0; corner < _in.node.size(); ++corner)
      if (_node[at(_in.node[corner])] >= 0)
        around[at(_node[at(_in.node[corner])])].push_back(corner);
    for (std::size_t node = 0; node < around.size(); ++node) {
      stop::look_at_turn(node, continuing);
      const std::optional<Run> stiff = run(around[node], true), soft = run(around[node], false);
      if (!stiff || !soft) return false;
      if (stiff->corner.size() + soft->corner.size() != around[node].size()) return false;
      if (!add_fan(node, *stiff, *soft)) return false;
    }
    return true;
  }

  /// The corners of one kind about a node; none if they are not one run, or if a slit of the stiff
  /// part or an inclusion ends there.
  std::optional<Run> run(const std::vector<std::size_t>& corners, bool stiff) const {
    std::optional<Run> found;
    for (const std::size_t corner : corners) {
      if (in_stiff(corner) != stiff) continue;
      const std::int32_t back = _in.across[preceding(corner)];
      if (back >= 0 && in_stiff(at(back)) == stiff) continue;
      if (found) return std::nullopt;
      found.emplace().corner.push_back(corner);
    }
    while (found) {
      const std::size_t spoke = following(found->corner.back());
      if (_in.across[spoke] < 0 || on_interface(spoke)) break;
      const Face* face = _in.face_of(spoke);
      if (face != nullptr && (stiff || face->inclusion >= 0)) return std::nullopt;
      found->corner.push_back(following(at(_in.across[spoke])));
    }
    double sum = 0;
    if (found) {
      for (const std::size_t corner : found->corner) {
        const Vector a = _in.side(preceding(corner)), b = _in.side(following(corner));
        sum += std::atan2(cross(b, a), -dot(a, b));
        found->until.push_back(sum);
      }
      for (double& one : found->until) one /= sum;
    }
    return found;
  }

  bool ends_held(std::size_t side) const {
    const Face* face = _in.face_of(side);
    return face != nullptr && is_boundary_value(*face);
  }

  bool add_fan(std::size_t node, const Run& stiff, const Run& soft) {
    // w_a is the mean of w over the first and the last spoke of the stiff run, with these weights.
    const bool first = on_interface(stiff.before()), last = on_interface(stiff.after());
    double weight[2] = {0.5, 0.5};
    if (!first || !last) {
      const std::size_t end = first ? stiff.after() : stiff.before(),
                        other = on_interface(soft.before()) ? soft.after() : soft.before();
      if (!ends_held(end) && ends_held(other)) return false;
      const bool use_end = ends_held(end);  // there w = 0
      weight[0] = first != use_end ? 1 : 0;
      weight[1] = 1 - weight[0];
    }
    const auto row = static_cast<Eigen::Index>(node);
    if (first) _means(row, _trace[stiff.before()]) += weight[0];
    if (last) _means(row, _trace[stiff.after()]) += weight[1];
    add_local(stiff, weight, factors(stiff, soft));
    return true;
  }

  /// The vector from the node of a corner to the point at part `part` of its run.
  Vector ray(const Run& run, std::size_t i, double part) const {
    const double from = i == 0 ? 0 : run.until[i - 1];
    const Vector a = _in.side(preceding(run.corner[i])), across = _in.side(run.corner[i]);
    return along(a, (part - from) / (run.until[i] - from), across);
  }

  /// The soft run is mapped to the stiff one, triangle by triangle between the rays of both. Per
  /// stiff triangle K: the largest factor by which |K| |grad psi|^2 |w o R - w_a|^2, with the other
  /// functions of a soft triangle, may exceed the mean of |w - w_a|^2 on K.
  std::vector<double> factors(const Run& stiff, const Run& soft) {
    std::vector<double> most(stiff.corner.size(), 0);
    std::size_t i = 0, j = stiff.corner.size() - 1;
    for (double from = 0;;) {
      const double j_end = j == 0 ? 1 : 1 - stiff.until[j - 1];
      const bool last = i + 1 == soft.corner.size(),
                 soft_ends = j == 0 || (!last && soft.until[i] <= j_end);
      const double to = last && j == 0 ? 1 : std::min(last ? 1 : soft.until[i], j_end);
      if (to - from > 1e-12) {
        const Vector a = ray(soft, i, from), b = ray(soft, i, to), c = ray(stiff, j, 1 - from),
                     d = ray(stiff, j, 1 - to);
        const double soft_area = cross(a, b), stiff_area = cross(d, c);
        // F a = c, F b = d: |F|^2 / |det F|
        const Vector x{(c[0] * b[1] - d[0] * a[1]) / soft_area,
                       (d[0] * a[0] - c[0] * b[0]) / soft_area},
            y{(c[1] * b[1] - d[1] * a[1]) / soft_area, (d[1] * a[0] - c[1] * b[0]) / soft_area};
        const double half = (square(x) + square(y)) * soft_area / (2 * stiff_area);
        _stretch = std::max(_stretch, half + std::sqrt(std::max(0.0, half * half - 1)));
        const std::size_t corner = soft.corner[i], t = corner / 3;
        double slopes = 0;
        for (std::size_t k = 3 * t; k < 3 * t + 3; ++k)
          if (_node[at(_in.node[k])] >= 0) slopes += std::abs(dot(_in.side(corner), _in.side(k)));
        const double area = _in.area(t);
        most[j] = std::max(most[j], slopes / (4 * area * area) * (soft_area / stiff_area) *
                                        _in.area(stiff.corner[j] / 3));
      }
      if (last && j == 0) return most;
      from = to;
      if (soft_ends)
        ++i;
      else
        --j;
    }
  }

  /// Adds to each triangle of the stiff run what its |grad w|^2 may add to the sum over K of most_K
  /// times the mean of |w - w_a|^2 on K.
  void add_local(const Run& run, const double (&weight)[2], const std::vector<double>& most) {
    const std::size_t n = run.corner.size();
    std::vector<double> along_run(n), own(n);
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t corner = run.corner[j], t = corner / 3;
      const double area = _in.area(t);
      const Vector to_first = _in.side(preceding(corner)), across = _in.side(corner),
                   to_last = along(to_first, 1, across), back = _in.side(following(corner));
      const double sides = square(to_first) + square(across) + square(back);
      // |w_K - w_a| in this triangle, from (x - P) / (2 |K|), P opposite to the spokes.
      const Vector p{weight[0] * to_last[0] + weight[1] * to_first[0],
                     weight[0] * to_last[1] + weight[1] * to_first[1]};
      const Vector centre{(to_first[0] + to_last[0]) / 3, (to_first[1] + to_last[1]) / 3};
      own[j] = std::sqrt((sides / 36 + square(along(centre, -1, p))) / (4 * area));
      along_run[j] = std::sqrt(square(across) / (4 * area));
      const double longest = std::max({square(to_first), square(across), square(back)});
      _local[t] += most[j] * longest / (j_11 * j_11 * area);  // Poincare
    }
    const auto factor = [&](std::size_t j, std::size_t i) {
      return i == j ? own[j] : along_run[i] * weight[i < j ? 0 : 1];
    };
    for (std::size_t j = 0; j < n; ++j) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += factor(j, i);
      for (std::size_t i = 0; i < n; ++i) _local[run.corner[i] / 3] += most[j] * sum * factor(j, i);
    }
  }

  /// int grad w . grad w' on the stiff pieces by the means w of edges, reduced to those of Gamma.
  Eigen::MatrixXd of_stiff() const {
    std::vector<std::int32_t> unknown(_trace.size(), none);
    std::int32_t interior = 0;
    for (std::size_t side = 0; side < unknown.size(); ++side) {
      if (_piece[side / 3] < 0 || _trace[side] >= 0 || ends_held(side)) continue;
      const bool shared = _in.across[side] >= 0 && _in.face[side] < 0;
      const std::size_t other = shared ? at(_in.across[side]) : side;
      unknown[side] = other < side ? unknown[other] : interior++;
    }
    for (std::size_t side = 0; side < unknown.size(); ++side)
      if (_trace[side] >= 0) unknown[side] = interior + _trace[side];
    Matrix matrix(at(interior) + _edges);
    for (std::size_t t = 0; t < _stiff.size(); ++t) {
      stop::look_at_turn(t, continuing);
      if (_piece[t] < 0) continue;
      add(matrix, t, &unknown[3 * t], 4);
      for (std::size_t side = 3 * t; side < 3 * t + 3; ++side) {
        const Vector &a = _in.place(following(side)), &b = _in.place(preceding(side));
        matrix.put(unknown[side], {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2});
      }
    }
    return matrix.schur(_edges);
  }

  /// The same of linear functions on the soft part, which are 0 on its inclusions and its Dirichlet
  /// boundary, by their values in the nodes of Gamma.
  Eigen::MatrixXd of_soft() const {
    std::vector<char> zero(_in.count, 0);
    for (std::size_t side = 0; side < _trace.size(); ++side) {
      const Face* face = _in.face_of(side);
      if (in_stiff(side) || face == nullptr || on_interface(side)) continue;
      if (!ends_held(side) && face->inclusion < 0) continue;
      for (const std::size_t corner : {following(side), preceding(side)})
        zero[at(_in.node[corner])] = 1;
    }
    std::vector<std::int32_t> unknown(_in.count, none);
    std::int32_t interior = 0;
    for (std::size_t corner = 0; corner < _in.node.size(); ++corner) {
      const auto node = at(_in.node[corner]);
      if (!in_stiff(corner) && _node[node] < 0 && zero[node] == 0 && unknown[node] < 0)
        unknown[node] = interior++;
    }
    for (std::size_t node = 0; node < _in.count; ++node)
      if (_node[node] >= 0) unknown[node] = interior + _node[node];
    Matrix matrix(at(interior + _nodes));
    for (std::size_t t = 0; t < _stiff.size(); ++t) {
      stop::look_at_turn(t, continuing);
      if (_stiff[t] != 0) continue;
      std::int32_t own[3];
      for (std::size_t i = 0; i < 3; ++i) {
        own[i] = unknown[at(_in.node[3 * t + i])];
        matrix.put(own[i], _in.place(3 * t + i));
      }
      add(matrix, t, own, 1);
    }
    return matrix.schur(at(_nodes));
  }

  void add(Matrix& matrix, std::size_t t, const std::int32_t* unknown, double factor) const {
    const double scale = factor / (4 * _in.area(t));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        matrix.add(unknown[i], unknown[j], scale * dot(_in.side(3 * t + i), _in.side(3 * t + j)));
  }

  const Triangulation& _in;
  const std::vector<char>& _stiff;
  std::vector<std::int32_t> _trace;  // per side of the stiff part: number of the edge of Gamma
  std::vector<std::int32_t> _node;   // per node: number on Gamma
  std::vector<std::int32_t> _piece;  // per triangle: of the stiff part
  std::int32_t _nodes = 0;
  std::size_t _edges = 0;
  Eigen::MatrixXd _means;      // (nodes, edges) w_a from the means of w over edges
  Eigen::MatrixXd _islands;    // (edges, islands) 1 on the edges of each
  double _stretch = 1;         // the most that a map of a fan multiplies int |grad w|^2 by
  std::vector<double> _local;  // per triangle: see add_local
};

}  // namespace

double continuation(const mesh::Mesh& mesh, const CutMesh& cut, const std::vector<char>& stiff) {
  return Continuation(Triangulation(mesh, cut), stiff)();
}

}  // namespace anticrack::estimate
