// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptive_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "fem/cut_cells.hpp"
#include "fem/integration.hpp"
#include "fem/load_proof.hpp"
#include "fem/triangle_rules.hpp"

namespace anticrack::fem {
namespace {

/// How many triangles are sampled at once.
constexpr std::size_t width = Cutter::width;
static_assert(width * rule_5.size <= Sampler::block);

using Lane = Cutter::Lane;

/// Points of rule_5 on the medians, by corner: the outer one is nearest to the corner, the inner
/// one farthest from it.
constexpr std::array<std::size_t, 3> outer_points{4, 6, 5}, inner_points{1, 3, 2};

/// The terms of the samples by degree. The points of rule_5 and the corners lie on the medians.
/// With r the signed distance from the centroid (1 at a corner), 1, r^2, r^3, r^4 span the part
/// that is equal on all medians, and r, r^2, r^3 the part that differs between them. Each part has
/// a basis that is orthonormal on the samples.
struct Terms {
  using Four = std::array<double, 4>;   // centroid, inner points, outer points, corners
  using Three = std::array<double, 3>;  // inner points, outer points, corners
  Four equal_2, equal_3, equal_4;
  Three other_1, other_2, other_3;

  Terms() {
    const auto distance = [](std::size_t point) {  // from 1 - b - c = 1/3 + 2/3 r
      return 1.5 * (1 - rule_5.b[point] - rule_5.c[point] - 1.0 / 3);
    };
    const Three r{distance(inner_points[0]), distance(outer_points[0]), 1};
    std::array<Four, 4> equal{};
    std::array<Three, 3> other{};
    for (std::size_t o = 0; o < 3; ++o) {
      for (std::size_t k = 0; k < 4; ++k) {
        equal[k][0] = k == 0 ? 1 : 0;
        equal[k][o + 1] = std::sqrt(3.0) * std::pow(r[o], k == 0 ? 0 : static_cast<double>(k + 1));
      }
      for (std::size_t k = 0; k < 3; ++k) other[k][o] = std::pow(r[o], static_cast<double>(k + 1));
    }
    orthonormalise(equal);
    orthonormalise(other);
    equal_2 = equal[1];
    equal_3 = equal[2];
    equal_4 = equal[3];
    other_1 = other[0];
    other_2 = other[1];
    other_3 = other[2];
  }

 private:
  template <class Vector, std::size_t N>
  static void orthonormalise(std::array<Vector, N>& basis) {
    for (std::size_t k = 0; k < N; ++k) {
      for (std::size_t i = 0; i < k; ++i) {
        const double overlap =
            std::inner_product(basis[k].begin(), basis[k].end(), basis[i].begin(), 0.0);
        for (std::size_t o = 0; o < basis[k].size(); ++o) basis[k][o] -= overlap * basis[i][o];
      }
      const double norm =
          std::sqrt(std::inner_product(basis[k].begin(), basis[k].end(), basis[k].begin(), 0.0));
      for (double& value : basis[k]) value /= norm;
    }
  }
};

class LoadIntegrator {
 public:
  LoadIntegrator(Integration& integration)
      : _integration(integration),
        _cutter(integration),
        _count(integration.triangles.size() / 3),
        _exact(integration.exact) {}

  /// Integrates f. `first_work`: see IntegrationLimits.
  void operator()(double first_work) {
    const double each = Integration::price(rule_5.size, _integration.f.cost()) + _cutter.cost();
    if (each * static_cast<double>(_count) > first_work) {
      interpolate();
      return;
    }
    if (!_exact) sample_nodes();
    for (std::size_t first = 0; first < _count; first += width)
      sample(first, std::min(width, _count - first));
    std::vector<Cell> cells;
    if (!_cut.empty()) {
      _integration.absolute += _absolute_of_cut;
      cells = _cutter.cut(_cut);
    }
    std::size_t kept = 0;
    for (const Coarse& one : _rest) {
      const double area = _integration.frame(one.triangle).area;
      if (one.error <= _integration.allowed(area, 1, one.found.absolute) &&
          one.trust == Trust::sound)
        _integration.add(one.triangle, one.found, one.error);
      else
        _rest[kept++] = one;
    }
    _rest.resize(kept);
    refine_cells(_integration, std::move(_rest), std::move(cells));
  }

 private:
  void sample_nodes() {
    const std::size_t count = _integration.xy.size() / 2;
    _at_nodes.resize(count);
    std::array<double, Sampler::block> x{}, y{};
    for (std::size_t first = 0; first < count; first += Sampler::block) {
      const std::size_t n = std::min(Sampler::block, count - first);
      for (std::size_t i = 0; i < n; ++i) {
        x[i] = _integration.xy[2 * (first + i)];
        y[i] = _integration.xy[2 * (first + i) + 1];
      }
      std::copy_n(_integration.f(x.data(), y.data(), n), n, &_at_nodes[first]);
      if (_integration.f.watches()) _integration.f.note_peaks(n);
    }
  }

  /// Interpolates f linearly between the nodes; every 64th block of triangles is sampled for the
  /// estimate of the error.
  void interpolate() {
    sample_nodes();
    for (std::size_t i = 0; i < _at_nodes.size(); ++i) {
      _integration.f.function().require_finite(_integration.xy[2 * i], _integration.xy[2 * i + 1],
                                               _at_nodes[i]);
    }
    _integration.interpolated = true;
    for (std::size_t t = 0; t < _count; ++t)
      _integration.area += std::max(0.0, _integration.frame(static_cast<std::int32_t>(t)).area);
    const bool exact = std::exchange(_exact, false);  // so that gather() reads the corners
    double error = 0, absolute = 0;
    for (std::size_t first = 0; first < _count; first += width) {
      const std::size_t n = std::min(width, _count - first);
      gather(first, n);
      const bool looked_at = first / width % 64 == 0;
      const double* values =
          looked_at ? _integration.f(_x.data(), _y.data(), rule_5.size * width) : nullptr;
      for (std::size_t t = 0; t < n; ++t) {
        const double p = _corner[0][t], q = _corner[1][t], r = _corner[2][t];
        const double part = _area[t] / 12, sum = p + q + r;
        const Moments linear{{4 * part * sum, part * (sum + q), part * (sum + r)},
                             4 * part * (std::abs(p) + std::abs(q) + std::abs(r))};
        _integration.add(static_cast<std::int32_t>(first + t), linear, 0);
        if (looked_at) {
          Moments sampled;
          for (std::size_t k = 0; k < rule_5.size; ++k) {
            sampled.add(_area[t] * rule_5.weight[k], {rule_5.b[k], rule_5.c[k]},
                        values[k * width + t]);
          }
          error += difference(sampled, linear);
          absolute += sampled.absolute;
        }
      }
    }
    _exact = exact;
    _integration.error = absolute > 0 ? error / absolute * _integration.settled : error;
  }

  void sample(std::size_t first, std::size_t n) {
    gather(first, n);
    std::array<bool, width> cut{};
    if (_cutter.needed()) _cutter.find(_frames, cut);
    const double* values = _integration.f(_x.data(), _y.data(), rule_5.size * width);
    for (std::size_t p = 0; p < rule_5.size; ++p) {
      const double weight = rule_5.weight[p], b = rule_5.b[p], c = rule_5.c[p];
      const double* v = values + p * width;
      for (std::size_t t = 0; t < width; ++t) {
        const double part = weight * v[t];
        _whole[t] = (p == 0 ? 0 : _whole[t]) + part;
        _of_b[t] = (p == 0 ? 0 : _of_b[t]) + part * b;
        _of_c[t] = (p == 0 ? 0 : _of_c[t]) + part * c;
        _absolute[t] = (p == 0 ? 0 : _absolute[t]) + std::abs(part);
      }
    }
    if (!_exact) {
      estimate(values);
      _integration.f.trust(rule_5.size, 1, _trust);
    }
    for (std::size_t t = 0; t < n; ++t) settle(first, t, cut[t], values);
  }

  void gather(std::size_t first, std::size_t n) {
    for (std::size_t t = 0; t < width; ++t) {
      const std::size_t number = first + std::min(t, n - 1);
      const Frame frame = frame_of(_integration.xy, _integration.triangles, number);
      _frames.x[t] = frame.x;
      _frames.y[t] = frame.y;
      _frames.bx[t] = frame.bx;
      _frames.by[t] = frame.by;
      _frames.cx[t] = frame.cx;
      _frames.cy[t] = frame.cy;
      _area[t] = std::max(0.0, frame.area);
      if (!_exact) {
        for (std::size_t i = 0; i < 3; ++i) {
          _corner[i][t] =
              _at_nodes[static_cast<std::size_t>(_integration.triangles[3 * number + i])];
        }
      }
    }
    for (std::size_t p = 0; p < rule_5.size; ++p) {
      for (std::size_t t = 0; t < width; ++t) {
        _x[p * width + t] =
            _frames.x[t] + rule_5.b[p] * _frames.bx[t] + rule_5.c[p] * _frames.cx[t];
        _y[p * width + t] =
            _frames.y[t] + rule_5.b[p] * _frames.by[t] + rule_5.c[p] * _frames.cy[t];
      }
    }
  }

  /// Estimates the error of a nodal value divided by the area: the terms of degree 5, if the decay
  /// of the terms goes on.
  void estimate(const double* values) {
    static const Terms terms;
    const auto [e2, e3, e4] = std::array{terms.equal_2, terms.equal_3, terms.equal_4};
    const auto [o1, o2, o3] = std::array{terms.other_1, terms.other_2, terms.other_3};
    const double third = std::sqrt(1.0 / 3), half = std::sqrt(0.5), sixth = std::sqrt(1.0 / 6);
    const auto point = [&](std::size_t number, std::size_t t) {
      return values[number * width + t];
    };
    for (std::size_t t = 0; t < width; ++t) {
      const double centre = point(0, t);
      const double i0 = point(inner_points[0], t), i1 = point(inner_points[1], t),
                   i2 = point(inner_points[2], t);
      const double p0 = point(outer_points[0], t), p1 = point(outer_points[1], t),
                   p2 = point(outer_points[2], t);
      const double c0 = _corner[0][t], c1 = _corner[1][t], c2 = _corner[2][t];
      const double si = third * (i0 + i1 + i2), sp = third * (p0 + p1 + p2),
                   sc = third * (c0 + c1 + c2);
      const double ai = half * (i0 - i1), ap = half * (p0 - p1), ac = half * (c0 - c1);
      const double bi = sixth * (i0 + i1 - 2 * i2), bp = sixth * (p0 + p1 - 2 * p2),
                   bc = sixth * (c0 + c1 - 2 * c2);
      const double equal2 = e2[0] * centre + e2[1] * si + e2[2] * sp + e2[3] * sc;
      const double equal3 = e3[0] * centre + e3[1] * si + e3[2] * sp + e3[3] * sc;
      const double equal4 = e4[0] * centre + e4[1] * si + e4[2] * sp + e4[3] * sc;
      const double a1 = o1[0] * ai + o1[1] * ap + o1[2] * ac,
                   b1 = o1[0] * bi + o1[1] * bp + o1[2] * bc;
      const double a2 = o2[0] * ai + o2[1] * ap + o2[2] * ac,
                   b2 = o2[0] * bi + o2[1] * bp + o2[2] * bc;
      const double a3 = o3[0] * ai + o3[1] * ap + o3[2] * ac,
                   b3 = o3[0] * bi + o3[1] * bp + o3[2] * bc;
      const double linear = a1 * a1 + b1 * b1, quadratic = equal2 * equal2 + a2 * a2 + b2 * b2,
                   cubic = equal3 * equal3 + equal4 * equal4 + a3 * a3 + b3 * b3;
      // The quadratic term may vanish by chance; then use the mean of its neighbours. 3 for safety.
      const double mean = std::sqrt(linear * cubic);
      const double before = quadratic > mean ? quadratic : mean;
      const double ratio = 3 * cubic / (before + std::numeric_limits<double>::min());
      _error[t] = 0.2 * std::sqrt(cubic) * (ratio < 1 ? ratio : 1.0);
    }
  }

  void settle(std::size_t first, std::size_t t, bool cut, const double* values) {
    const auto number = static_cast<std::int32_t>(first + t);
    const double area = _area[t];
    if (!(area > 0)) return;
    _integration.area += area;
    if (cut) {
      _absolute_of_cut += std::isfinite(_absolute[t]) ? area * _absolute[t] : 0;
      _cut.push_back(number);
      ++_integration.cut;
      return;
    }
    if (!std::isfinite(_absolute[t])) {
      for (std::size_t p = 0; p < rule_5.size; ++p) {
        const std::size_t i = p * width + t;
        _integration.f.function().require_finite(_x[i], _y[i], values[i]);
      }
    }
    const Moments found{{area * _whole[t], area * _of_b[t], area * _of_c[t]}, area * _absolute[t]};
    _integration.absolute += found.absolute;
    const double error = area * _error[t];
    if (error <= 0.5 * _integration.tolerance * found.absolute && _trust[t] == Trust::sound) {
      _integration.add(number, found, error);
    } else {
      _rest.push_back({number, _trust[t], found,
                       std::isfinite(error) ? error : std::numeric_limits<double>::max()});
    }
  }

  Integration& _integration;
  Cutter _cutter;
  std::size_t _count;
  bool _exact;
  std::vector<double> _at_nodes;
  std::vector<std::int32_t> _cut;
  std::vector<Coarse> _rest;
  double _absolute_of_cut = 0;
  std::array<double, rule_5.size * width> _x{}, _y{};
  Cutter::Frames _frames{};
  Lane _area{};
  std::array<Trust, width> _trust{};
  Lane _whole{}, _of_b{}, _of_c{}, _absolute{}, _error{};
  std::array<Lane, 3> _corner{};
};

}  // namespace

IntegrationReport integrate_load(std::span<const double> xy,
                                 std::span<const std::int32_t> triangles,
                                 const expression::Function& f, std::span<double> load,
                                 const IntegrationLimits& limits, ForceParts* parts,
                                 std::vector<Spread>* spread) {
  std::fill(load.begin(), load.end(), 0.0);
  Sampler sampler(f);
  ForceParts own;
  if (parts == nullptr) parts = &own;
  parts->load.assign(triangles.size(), 0);
  Integration integration{xy, triangles, sampler, load, limits.relative_tolerance, limits.work};
  integration.parts = parts;
  const expression::Tape& tape = f.tape();
  integration.exact = tape.degree_between_switches(tape.result()) <= 4;
  LoadIntegrator integrator(integration);
  integrator(limits.first_work);
  IntegrationReport report;
  report.cut_triangles = integration.cut;
  // Samples may have missed most of f.
  double whole = 0;
  for (const double value : load) whole += value;
  const double absolute = std::max(integration.settled, std::abs(whole));
  report.relative_error_estimate = integration.error > 0 ? integration.error / absolute : 0;
  ProofOptions options;
  options.tolerance = limits.proof_tolerance;
  options.work = limits.proof_work;
  options.absolute = absolute;
  options.area = integration.area;
  options.exact = integration.exact && tape.switches().empty();
  options.interpolated = integration.interpolated;
  options.curved = integration.curved;
  options.spread = spread;
  report.proof = prove_load(xy, triangles, f, *parts, load, options);
  report.evaluations = sampler.count();
  return report;
}

}  // namespace anticrack::fem
