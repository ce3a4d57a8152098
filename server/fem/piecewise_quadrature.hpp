// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "fem/lobatto_rules.hpp"
#include "fem/scalar_field.hpp"

namespace anticrack::fem {

/// What an integrand returns at t: K values, and how wrong they may be (0 for exact values).
template <std::size_t K>
struct Reading {
  std::array<double, K> value{};
  double error = 0;
};

/// int g dt and int t g dt, with an estimate of the greatest error among the K integrals of g.
/// First moments are as accurate where |t| <= 1: scale the variable accordingly.
template <std::size_t K>
struct PiecewiseIntegral {
  std::array<double, K> zeroth{};
  std::array<double, K> first{};
  double error = 0;
  std::vector<double> jumps;  ///< where g was found to jump, in the order of finding
  std::vector<double> kinks;  ///< where its slope was
};

struct PiecewiseControl {
  double tolerance = 0;   ///< absolute, for the whole integral
  double resolution = 0;  ///< a jump is located to this width; it must exceed the rounding of t
};

/// Integrates a piecewise smooth function of one variable whose breaks are not known.
///
/// A panel is measured by the nested Lobatto rules of 4 and 7, then 13 points (lobatto_rules.hpp),
/// ends included: a break is seen wherever it separates two samples. A rough panel is searched:
/// halving towards the greater difference closes in on a jump, towards the greatest second
/// difference on a kink, and the panel is split there; otherwise it is split in the middle. So a
/// jump costs some 40 evaluations and leaves no error but its height times the resolution.
///
/// Missed: what no sample sees, e.g. a strip between two neighbouring points of the rule.
template <std::size_t K, class Function>
class PiecewiseQuadrature {
 public:
  /// `g` maps t to Reading<K>; it counts its evaluations in `field`.
  PiecewiseQuadrature(Function& g, const CountedField& field, PiecewiseControl control)
      : _g(g), _field(field), _control(control) {}

  /// `ends`: of the first panels, ascending, at least 2; put them where breaks are known.
  PiecewiseIntegral<K> operator()(std::span<const double> ends) {
    _result = {};
    _length = ends.back() - ends.front();
    Sample low = at(ends.front());
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const Sample high = at(ends[i]);
      add(low, high, {}, 0);
      low = high;
    }
    return _result;
  }

 private:
  struct Sample {
    double t = 0;
    Reading<K> g;
  };
  using Panel = std::array<Sample, 7>;

  /// How a panel was integrated by a rule.
  struct Measure {
    std::array<double, K> zeroth{};
    std::array<double, K> first{};
    double error = 0;      ///< of the rule, estimated from the smaller rule's
    double inherited = 0;  ///< of the readings
    bool rough = false;    ///< the two rules differ like the function does: a break is likely
  };

  /// Ends of a panel where a kink was found: what is still rough there is a singularity, and
  /// halving panels towards it is the cure, not another search.
  struct Known {
    bool low = false;
    bool high = false;
  };

  static constexpr int max_depth = 48;
  /// Leaves a kink in 1e-5 of a panel, where the curvature of either side moves the meeting point
  /// of the tangents by 1e-10 of its own effect, and rounding of the slopes by less than that.
  static constexpr int kink_halvings = 16;
  /// A panel's part of the tolerance is not less than this: panels shrink geometrically towards a
  /// singularity, and few can be so small.
  static constexpr double least_part = 1e-3;

  Sample at(double t) { return {t, _g(t)}; }

  static double difference(const Sample& a, const Sample& b) {
    double greatest = 0;
    for (std::size_t k = 0; k < K; ++k) {
      greatest = std::max(greatest, std::abs(a.g.value[k] - b.g.value[k]));
    }
    return greatest;
  }

  static double second_difference(const Sample& a, const Sample& b, const Sample& c) {
    const double part = (b.t - a.t) / (c.t - a.t);
    double greatest = 0;
    for (std::size_t k = 0; k < K; ++k) {
      const double chord = a.g.value[k] + part * (c.g.value[k] - a.g.value[k]);
      greatest = std::max(greatest, std::abs(b.g.value[k] - chord));
    }
    return greatest;
  }

  template <std::size_t N>
  static Measure measure(const std::array<Sample, N>& panel, const LobattoPair<N>& rule) {
    const double middle = 0.5 * (panel.front().t + panel.back().t);
    const double half = 0.5 * (panel.back().t - panel.front().t);
    Measure result;
    for (std::size_t i = 0; i < N; ++i) {
      result.inherited += half * rule.fine[i] * panel[i].g.error;
    }
    for (std::size_t k = 0; k < K; ++k) {
      double mean = 0, tilt = 0, mean_gap = 0, tilt_gap = 0;
      for (std::size_t i = 0; i < N; ++i) {
        const double value = panel[i].g.value[k], excess = rule.fine[i] - rule.coarse[i];
        mean += 0.5 * rule.fine[i] * value;
        tilt += 1.5 * rule.fine[i] * rule.nodes[i] * value;
        mean_gap += excess * value;
        tilt_gap += excess * rule.nodes[i] * value;
      }
      double bend = 0;  // how far the values are from a straight line, in the mean
      for (std::size_t i = 0; i < N; ++i) {
        bend += rule.fine[i] * std::abs(panel[i].g.value[k] - mean - tilt * rule.nodes[i]);
      }
      result.zeroth[k] = 2 * half * mean;
      result.first[k] = middle * result.zeroth[k] + half * half * tilt * (2.0 / 3);
      const double gap = std::max(std::abs(mean_gap), std::abs(tilt_gap));
      // QUADPACK's guess of the finer rule's error; never more than what a straight line leaves.
      const double ratio = bend > 0 ? 200 * gap / bend : 0;
      result.error = std::max(result.error, half * bend * std::min(1.0, ratio * std::sqrt(ratio)));
      result.rough = result.rough || ratio > 4;
    }
    return result;
  }

  void add(const Sample& low, const Sample& high, Known known, int depth) {
    const double width = high.t - low.t;
    if (width <= 16 * _control.resolution) {
      add_gap(low, high);
      return;
    }
    Panel panel;
    panel.front() = low;
    panel.back() = high;
    const double middle = low.t + 0.5 * width;
    for (std::size_t i = 1; i + 1 < panel.size(); ++i) {
      panel[i] = at(middle + 0.5 * width * lobatto_4_7.nodes[i]);
    }
    const Measure found = measure(panel, lobatto_4_7);
    const double allowed = _control.tolerance * std::max(width / _length, least_part);
    if (found.error <= allowed || depth == max_depth || _field.exhausted()) {
      accept(found);
      return;
    }
    if (found.rough) {
      if (split_at_jump(panel, known, depth) || split_at_kink(panel, known, depth)) {
        return;
      }
    } else {
      const Measure finer = measure(refined(panel), lobatto_7_13);
      if (finer.error <= allowed) {
        accept(finer);
        return;
      }
    }
    add(low, panel[3], {known.low, false}, depth + 1);
    add(panel[3], high, {false, known.high}, depth + 1);
  }

  std::array<Sample, 13> refined(const Panel& panel) {
    std::array<Sample, 13> finer;
    const double middle = panel[3].t, half = 0.5 * (panel.back().t - panel.front().t);
    for (std::size_t i = 0; i < finer.size(); ++i) {
      finer[i] = i % 2 == 0 ? panel[i / 2] : at(middle + half * lobatto_7_13.nodes[i]);
    }
    return finer;
  }

  void accept(const Measure& found) {
    for (std::size_t k = 0; k < K; ++k) {
      _result.zeroth[k] += found.zeroth[k];
      _result.first[k] += found.first[k];
    }
    _result.error += found.error + found.inherited;
  }

  /// A stretch too short to be divided, e.g. what is left of it around a jump.
  void add_gap(const Sample& low, const Sample& high) {
    const double gap = high.t - low.t;
    for (std::size_t k = 0; k < K; ++k) {
      const double piece = 0.5 * gap * (low.g.value[k] + high.g.value[k]);
      _result.zeroth[k] += piece;
      _result.first[k] += 0.5 * (low.t + high.t) * piece;
    }
    _result.error += 0.5 * gap * (difference(low, high) + low.g.error + high.g.error);
  }

  bool split_at_jump(const Panel& panel, Known known, int depth) {
    std::size_t widest = 0;
    for (std::size_t i = 1; i + 1 < panel.size(); ++i) {
      if (difference(panel[i], panel[i + 1]) > difference(panel[widest], panel[widest + 1])) {
        widest = i;
      }
    }
    if ((known.low && widest == 0) || (known.high && widest + 2 == panel.size())) {
      return false;
    }
    Sample low = panel[widest], high = panel[widest + 1];
    if (!close_in_on_jump(low, high)) {
      return false;
    }
    _result.jumps.push_back(0.5 * (low.t + high.t));
    // Rounding may mix the two sides where the function is evaluated right at the jump, and the
    // ends of panels carry weight: step back.
    const double step = high.t - low.t;
    if (low.t - step > panel.front().t) {
      low = at(low.t - step);
    }
    if (high.t + step < panel.back().t) {
      high = at(high.t + step);
    }
    add_gap(low, high);
    add(panel.front(), low, {known.low, false}, depth + 1);
    add(high, panel.back(), {false, known.high}, depth + 1);
    return true;
  }

  /// Narrows [low, high] to the resolution. False when the difference shrinks with the interval,
  /// as it does unless there is a jump.
  bool close_in_on_jump(Sample& low, Sample& high) {
    double height = difference(low, high), before = height;
    for (int level = 1; high.t - low.t > _control.resolution; ++level) {
      const Sample middle = at(low.t + 0.5 * (high.t - low.t));
      const double left = difference(low, middle), right = difference(middle, high);
      (left >= right ? high : low) = middle;
      height = std::max(left, right);
      if (level % 4 == 0) {
        if (height <= 0.3 * before) {
          return false;
        }
        before = height;
      }
    }
    return height > 0;
  }

  bool split_at_kink(const Panel& panel, Known known, int depth) {
    std::size_t bent = 1;
    for (std::size_t i = 2; i + 1 < panel.size(); ++i) {
      if (second_difference(panel[i - 1], panel[i], panel[i + 1]) >
          second_difference(panel[bent - 1], panel[bent], panel[bent + 1])) {
        bent = i;
      }
    }
    if ((known.low && bent == 1) || (known.high && bent + 2 == panel.size())) {
      return false;
    }
    Sample low = panel[bent - 1], high = panel[bent + 1];
    Sample middle = at(low.t + 0.5 * (high.t - low.t));
    if (!close_in_on_kink(low, middle, high)) {
      return false;
    }
    middle = at(where_tangents_meet(panel, low, middle, high));
    _result.kinks.push_back(middle.t);
    // The rough stretch apart: more may be in it that the panel's own points do not show.
    const Sample &below = panel[bent - 1], &above = panel[bent + 1];
    if (bent > 1) {
      add(panel.front(), below, {known.low, false}, depth + 1);
    }
    add(below, middle, {known.low && bent == 1, true}, depth + 1);
    add(middle, above, {true, known.high && bent + 2 == panel.size()}, depth + 1);
    if (bent + 2 < panel.size()) {
      add(above, panel.back(), {false, known.high}, depth + 1);
    }
    return true;
  }

  /// Narrows three equidistant samples around a kink, until tangents tell where it is. False when
  /// the second difference shrinks with the square of the interval, as it does where the function
  /// is smooth.
  bool close_in_on_kink(Sample& low, Sample& middle, Sample& high) {
    double before = second_difference(low, middle, high);
    for (int level = 1; level <= kink_halvings && high.t - low.t > 4 * _control.resolution;
         ++level) {
      const Sample left = at(low.t + 0.5 * (middle.t - low.t));
      const Sample right = at(middle.t + 0.5 * (high.t - middle.t));
      const double at_left = second_difference(low, left, middle);
      const double at_middle = second_difference(left, middle, right);
      const double at_right = second_difference(middle, right, high);
      double bend = at_middle;
      if (at_left > std::max(at_middle, at_right)) {
        bend = at_left;
        high = middle;
        middle = left;
      } else if (at_right > at_middle) {
        bend = at_right;
        low = middle;
        middle = right;
      } else {
        low = left;
        high = right;
      }
      if (level % 4 == 0) {
        if (bend <= before / 80) {
          return false;
        }
        before = bend;
      }
    }
    return true;
  }

  /// The ends of panels carry weight, so a kink is wanted nearer than halving can tell.
  double where_tangents_meet(const Panel& panel, const Sample& low, const Sample& middle,
                             const Sample& high) {
    const double step = middle.t - low.t;
    if (low.t - step < panel.front().t || high.t + step > panel.back().t) {
      return middle.t;
    }
    const Sample before = at(low.t - step), after = at(high.t + step);
    double sharpest = 0, meet = middle.t;
    for (std::size_t k = 0; k < K; ++k) {
      const double left = (low.g.value[k] - before.g.value[k]) / step;
      const double right = (after.g.value[k] - high.g.value[k]) / step;
      if (std::abs(right - left) > sharpest) {
        sharpest = std::abs(right - left);
        const double rise = high.g.value[k] - low.g.value[k];
        meet = low.t + (right * (high.t - low.t) - rise) / (right - left);
      }
    }
    return low.t < meet && meet < high.t ? meet : middle.t;
  }

  Function& _g;
  const CountedField& _field;
  PiecewiseControl _control;
  double _length = 0;
  PiecewiseIntegral<K> _result;
};

}  // namespace anticrack::fem
