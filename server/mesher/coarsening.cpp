// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/coarsening.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "base/at.hpp"
#include "mesh/geometry_steps.hpp"

namespace anticrack::mesher {
namespace {

/// Least triangles of a coarse mesh: with so many, shapes are as good as those of a finer mesh.
constexpr double coarse_triangles = 10'000;

/// By which fraction halving may make more triangles than meshing at once.
constexpr double most_in_excess = 0.05;

/// By how much a chord of a bend may turn in the coarse mesh, radians.
constexpr double most_turn = std::numbers::pi / 9;

/// Curves that are chords of one bend, each beginning where the one before it ends, or one curve.
struct Run {
  std::size_t first = 0;  ///< index of a curve
  std::size_t count = 1;  ///< curves, in the order of their indices
  bool reversed = false;  ///< the walk along the chords begins with the last of them
  int intervals = 1;      ///< of all curves
  double interval = 0;    ///< length of the longest one
  double turn = 0;        ///< radians; 0: a straight line
};

double turn_of(const mesh::Plan& plan, const mesh::PlannedCurve& chord) {
  const mesh::Bend& bend = plan.bends[at(chord.bend)];
  const mesh::Point d = bend.derivative(chord.from), e = bend.derivative(chord.to);
  return std::abs(std::atan2(d[0] * e[1] - d[1] * e[0], d[0] * e[0] + d[1] * e[1]));
}

/// Whether two chords are alike and lie one behind the other, walked as written or against it.
bool continues(const mesh::PlannedCurve& one, const mesh::PlannedCurve& next, bool reversed) {
  const auto same = [](const mesh::PlannedCurve& c) {
    return std::tie(c.bend, c.role, c.left, c.right, c.kind, c.inclusion);
  };
  return one.bends() && next.bends() && same(one) == same(next) &&
         (reversed ? next.b == one.a : one.b == next.a);
}

std::vector<Run> runs_of(const mesh::Plan& plan) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < plan.curves.size(); ++i) {
    const mesh::PlannedCurve& curve = plan.curves[i];
    const bool more = !runs.empty() && runs.back().first + runs.back().count == i;
    const bool reversed = curve.bends() && curve.from > curve.to;
    if (more && runs.back().reversed == reversed &&
        continues(plan.curves[i - 1], curve, reversed)) {
      ++runs.back().count;
      runs.back().intervals += curve.intervals;
    } else {
      runs.push_back({.first = i, .reversed = reversed, .intervals = curve.intervals});
    }
    runs.back().interval =
        std::max(runs.back().interval, mesh::length_of(plan, curve) / curve.intervals);
    if (curve.bends()) runs.back().turn += turn_of(plan, curve);
  }
  return runs;
}

double longest_interval(const std::vector<Run>& runs) {
  double longest = 0;
  for (const Run& run : runs) longest = std::max(longest, run.interval);
  return longest;
}

/// The intervals of a run in the coarse mesh: one in place of `parts`. Intervals much shorter than
/// the `longest` ones are so short because of what is near them, and stay. A longer chord stays
/// within a quarter of the shorter ones' length of the bend: what shares no point with these is
/// further off than half their length.
int coarse_intervals(const Run& run, double longest, int parts) {
  if (run.interval < longest / 2) return run.intervals;
  const auto least = static_cast<int>(
      std::ceil(std::max(run.turn / most_turn, std::sqrt(run.turn * run.intervals / 2))));
  return std::clamp((run.intervals + parts - 1) / parts, std::min(least, run.intervals),
                    run.intervals);
}

/// An estimate of how many more triangles halving makes along all curves and around them. Edges
/// that are shorter by a factor r grow by `growth` per length away from the curve: a band on both
/// sides of it and discs around its ends have more triangles.
double excess(const std::vector<Run>& runs, double growth, int halvings) {
  const int parts = 1 << halvings;
  const double triangle = std::sqrt(3.0) / 4;  // area of an equilateral one with edge length 1
  const double longest = longest_interval(runs);
  double coarse = 0;
  for (const Run& run : runs) {
    const int intervals = coarse_intervals(run, longest, parts);
    const double r = static_cast<double>(intervals) * parts / run.intervals;
    if (r == 1) continue;
    coarse += intervals * 2 * (1 - 1 / r) / (triangle * growth) +
              2 * std::numbers::pi * std::log(r) / (triangle * growth * growth);
  }
  return coarse * parts * parts;
}

/// The chords of a run in the coarse mesh, in the order of the walk; `intervals` of them, with new
/// points where they do not end where old ones do.
std::vector<mesh::PlannedCurve> chords_of(mesh::Plan& plan, const Run& run, int intervals) {
  const auto chord = [&](std::size_t k) -> const mesh::PlannedCurve& {
    return plan.curves[run.first + (run.reversed ? run.count - 1 - k : k)];
  };
  std::vector<mesh::PlannedCurve> chords(at(intervals), chord(0));
  for (std::size_t k = 1; k < chords.size(); ++k) {
    const double place = static_cast<double>(k * run.count) / intervals;
    const auto whole = static_cast<std::size_t>(place);
    const mesh::PlannedCurve& on = chord(whole);
    const double t = on.from + (on.to - on.from) * (place - static_cast<double>(whole));
    chords[k - 1].to = chords[k].from = t;
    chords[k - 1].b = chords[k].a = static_cast<int>(plan.points.size());
    plan.points.push_back(plan.bends[at(on.bend)].at(t));
  }
  chords.back().to = chord(run.count - 1).to;
  chords.back().b = chord(run.count - 1).b;
  return chords;
}

/// Leaves out the points that no curve ends at.
void drop_points(mesh::Plan& plan) {
  std::vector<int> number(plan.points.size(), -1);
  for (const mesh::PlannedCurve& curve : plan.curves) number[at(curve.a)] = number[at(curve.b)] = 0;
  std::vector<mesh::Point> points;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(points.size());
    points.push_back(plan.points[i]);
  }
  for (mesh::PlannedCurve& curve : plan.curves)
    for (int* end : {&curve.a, &curve.b}) *end = number[at(*end)];
  plan.points = std::move(points);
}

}  // namespace

int halvings(const mesh::Plan& plan) {
  const auto expected = static_cast<double>(plan.triangles);
  int most = 0;
  while (expected >= std::pow(4, most + 1) * coarse_triangles) ++most;
  const std::vector<Run> runs = runs_of(plan);
  while (most > 0 && excess(runs, plan.growth, most) > most_in_excess * expected) --most;
  return most;
}

mesh::Plan coarsened(mesh::Plan plan, int halvings) {
  if (halvings == 0) return plan;
  const std::vector<Run> runs = runs_of(plan);
  const double longest = longest_interval(runs);
  std::vector<mesh::PlannedCurve> curves;
  std::vector<std::vector<int>> pieces(plan.curves.size());
  for (const Run& run : runs) {
    const int intervals = coarse_intervals(run, longest, 1 << halvings);
    const auto first = static_cast<int>(curves.size());
    if (run.count == 1) {
      curves.push_back(plan.curves[run.first]);
      curves.back().intervals = intervals;
    } else {
      std::ranges::copy(chords_of(plan, run, intervals), std::back_inserter(curves));
    }
    for (int k = first; k < static_cast<int>(curves.size()); ++k) pieces[run.first].push_back(k);
  }
  mesh::replace_curves(plan, std::move(curves), pieces);
  drop_points(plan);
  return plan;
}

}  // namespace anticrack::mesher
