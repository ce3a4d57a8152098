// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fluxes on random membranes of all kinds: what they must be, face by face, and that the bound of
// the energy is the same whatever it is taken from.
#include "estimate/equilibrated_flux.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "base/at_once.hpp"
#include "estimate/solved.hpp"
#include "support/random_seed.hpp"

namespace anticrack::estimate {
namespace {

struct Tally {
  int fluxes = 0, without = 0, unsolved = 0, blocks = 0;
  double identity = 0, imbalance = 0, off = 0;
};

/// sigma.n as long as the side in its ends, which are numbered counterclockwise.
class Normal {
 public:
  Normal(const Solved& in, const EquilibratedFlux& flux) : _in(in), _flux(flux) {}
  double operator()(std::size_t side, std::size_t end) const {
    const std::size_t t = side / 3;
    std::array<double, 3> place{};
    place[(side + 1 + end - 3 * t) % 3] = 1;
    const Vector off = _flux.difference(t, place), slope = _in.gradient(t, _in.u);
    double sum = 0;
    for (std::size_t d = 0; d < 2; ++d)
      sum += (off[d] + _in.tension(t) * slope[d]) * _in.normal(side)[d];
    return sum;
  }
  double mean(std::size_t side) const { return ((*this)(side, 0) + (*this)(side, 1)) / 2; }
  /// The moment of sigma.n along the side, linear as the lever is.
  double moment(std::size_t side, double from, double to) const {
    const double a = (*this)(side, 0), b = (*this)(side, 1);
    return (2 * a * from + a * to + b * from + 2 * b * to) / 6;
  }

 private:
  const Solved& _in;
  const EquilibratedFlux& _flux;
};

/// Whether nothing but the load acts on an inclusion: it is not held and shares no node.
std::vector<bool> lie_alone(const Solved& in) {
  std::vector<bool> alone(in.mesh->inclusions.size(), true);
  std::map<std::int32_t, std::int32_t> owner;
  for (const auto& [a, b] : in.mesh->dirichlet) owner[a] = owner[b] = -1;
  for (const mesh::Interface& line : in.mesh->interfaces) {
    for (std::size_t e = 0; e < line.kind.size(); ++e) {
      const std::int32_t j = line.inclusion[e];
      for (const std::int32_t node : {line.nodes[e], line.nodes[e + 1]}) {
        if (j < 0) continue;
        const std::int32_t before = owner.try_emplace(node, j).first->second;
        if (before == j) continue;
        alone[at(j)] = false;
        if (before >= 0) alone[at(before)] = false;
      }
    }
  }
  for (std::size_t j = 0; j < in.mesh->motions.size(); ++j)
    if (in.mesh->motions[j].fixed) alone[j] = false;
  return alone;
}

/// What the flux is made to satisfy, from its values on the sides of triangles alone; the largest
/// fault over the largest flux.
double largest_fault(const Solved& in, const EquilibratedFlux& flux) {
  const Normal normal(in, flux);
  double largest = 1e-12, fault = 0;
  const auto expect_zero = [&](double value) { fault = std::max(fault, std::abs(value)); };
  const auto expect_pressure = [&](double value) { fault = std::max(fault, value); };
  std::vector<bool> is_face(in.cut.copy.size(), false);
  for (const Face& face : in.cut.faces) is_face[at(face.side)] = true;
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> inside;
  for (std::size_t t = 0; t < in.cut.triangle_count(); ++t) {
    double sum = in.force[3 * t] + in.force[3 * t + 1] + in.force[3 * t + 2];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t side = 3 * t + i;
      sum += normal.mean(side);
      largest = std::max(largest, std::abs(normal.mean(side)));
      const std::int32_t* node = &in.mesh->triangles[3 * at(in.cut.triangle[t])];
      if (!is_face[side]) inside[std::minmax(node[(i + 1) % 3], node[(i + 2) % 3])].push_back(side);
    }
    expect_zero(sum);  // the divergence
  }
  for (const auto& [ends, sides] : inside) {
    EXPECT_EQ(sides.size(), 2U);
    for (const std::size_t end : {0U, 1U})
      expect_zero(normal(sides[0], end) + normal(sides.back(), 1 - end));
  }
  std::vector<std::array<double, 3>> on_inclusion(in.mesh->inclusions.size());
  for (std::size_t f = 0; f < in.cut.faces.size(); ++f) {
    const Face& face = in.cut.faces[f];
    const std::size_t side = at(face.side);
    for (const std::size_t end : {0U, 1U}) {
      if (face.condition == Condition::crack_plus)
        expect_zero(normal(side, end) + normal(at(in.cut.faces[at(face.other)].side), 1 - end));
      if (presses(face.condition)) expect_pressure(normal(side, end));
      if (face.condition == Condition::given) {
        const auto load = 2 * static_cast<std::size_t>(std::max(0, face.traction));
        const bool loaded = face.traction >= 0 && !in.traction.empty();
        expect_zero(normal(side, end) - (loaded ? in.traction[load] + in.traction[load + 1] : 0));
      }
    }
    if (face.inclusion < 0) continue;
    const Vector centre = in.parts.decomposition.skeleton.motions[at(face.inclusion)].centre;
    const auto ends = in.cut.ends(face);
    on_inclusion[at(face.inclusion)][0] += normal.mean(side);
    for (std::size_t d = 0; d < 2; ++d)
      on_inclusion[at(face.inclusion)][1 + d] += normal.moment(
          side, in.cut.at[at(ends[0])][d] - centre[d], in.cut.at[at(ends[1])][d] - centre[d]);
  }
  const std::vector<bool> alone = lie_alone(in);
  for (std::size_t j = 0; j < on_inclusion.size(); ++j) {
    if (!alone[j]) continue;
    const contact::RigidForce& given = in.load.inclusion_forces[j].on_nodes;
    expect_zero(on_inclusion[j][0] - given.force);
    if (in.cut.tilts[j] == 0) continue;
    expect_zero(on_inclusion[j][1] - given.moment_x);
    expect_zero(on_inclusion[j][2] - given.moment_y);
  }
  return fault / largest;
}

/// D = Pi(v) - |sigma - T grad v|^2 / 2 - int p_s [v] with v the solution of the finer mesh.
double dual_from_fine(const Nested& nested, const EquilibratedFlux& flux) {
  double half = 0;
  integrate(nested, [&](std::size_t t, std::size_t in, const auto& place, double weight) {
    const Vector own = nested.fine->gradient(t, nested.fine->u),
                 before = nested.coarse->gradient(in, nested.coarse->u),
                 off = flux.difference(in, place);
    const double tension = nested.fine->tension(t);
    for (std::size_t d = 0; d < 2; ++d)
      half += 0.5 * weight / tension * std::pow(off[d] + tension * (before[d] - own[d]), 2);
  });
  return nested.fine->answer.energy - half - work_of_pressure(nested, flux);
}

/// D = - |sigma|^2 / 2 + int_GD sigma.n g_D. What values held on inclusions do is no part of this.
double dual_alone(const Nested& nested, const EquilibratedFlux& flux) {
  const Solved& coarse = *nested.coarse;
  double sum = 0;
  integrate(nested, [&](std::size_t, std::size_t in, const auto& place, double weight) {
    const Vector slope = coarse.gradient(in, coarse.u), off = flux.difference(in, place);
    for (std::size_t d = 0; d < 2; ++d)
      sum -=
          0.5 * weight / coarse.tension(in) * std::pow(off[d] + coarse.tension(in) * slope[d], 2);
  });
  const Normal normal(coarse, flux);
  for (const Face& face : coarse.cut.faces) {
    if (face.condition != Condition::free || face.inclusion >= 0) continue;
    const auto ends = coarse.cut.ends(face);
    sum += normal.moment(at(face.side), coarse.u[at(ends[0])], coarse.u[at(ends[1])]);
  }
  return sum;
}

void check(unsigned seed, bool rich, Tally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Nested nested(seed, rich);
  if (!nested.solved()) {
    ++tally.unsolved;
    return;
  }
  const Solved& coarse = *nested.coarse;
  if (!coarse.cut.obstacle.empty()) {
    ++tally.without;
    return;
  }
  ++tally.fluxes;
  const EquilibratedFlux flux(coarse.cut, coarse.balance());
  double half = 0;
  for (const double one : flux.distance()) half += 0.5 * one;
  for (const double one : flux.work_of_pressure()) half += one;
  const double dual = coarse.answer.energy - half;
  const double scale = std::abs(coarse.answer.energy) + flux.norm_squared();
  const double from_fine = dual_from_fine(nested, flux);
  tally.identity = std::max(tally.identity, std::abs(dual - from_fine) / scale);
  EXPECT_NEAR(dual, from_fine, 1e-10 * scale);
  if (!rich) {
    const double alone = dual_alone(nested, flux);
    tally.identity = std::max(tally.identity, std::abs(dual - alone) / scale);
    EXPECT_NEAR(dual, alone, 1e-10 * scale);
  }
  const double fault = largest_fault(coarse, flux);
  tally.off = std::max(tally.off, fault);
  EXPECT_LT(fault, 1e-10);
  tally.imbalance = std::max(tally.imbalance, flux.imbalance() / std::sqrt(scale));
  EXPECT_LT(dual, nested.fine->answer.energy + 1e-12 * scale);
  tally.blocks += coarse.cut.block_count() > 1 ? 1 : 0;
  const base::Threads helped(3);
  EXPECT_EQ(EquilibratedFlux(coarse.cut, coarse.balance()).distance(), flux.distance());
  const std::vector<Balance> several(1 + seed % 5, coarse.balance());
  for (const EquilibratedFlux& one : EquilibratedFlux::of_all(coarse.cut, several)) {
    EXPECT_EQ(one.distance(), flux.distance());
    EXPECT_EQ(one.norm_squared(), flux.norm_squared());
    EXPECT_EQ(one.through_faces(), flux.through_faces());
  }
}

class Fluxes : public ::testing::TestWithParam<bool> {};

TEST_P(Fluxes, AreInEquilibriumOnRandomMembranes) {
  const unsigned first = testing::random_seed();
  Tally tally;
  for (unsigned k = 0; k < 200; ++k) check(first + k, GetParam(), tally);
  std::printf(
      "[ figures  ] seeds from %u: %d fluxes, %d without, %d unsolved; identity %.1e, fault %.1e, "
      "imbalance %.1e\n",
      first, tally.fluxes, tally.without, tally.unsolved, tally.identity, tally.off,
      tally.imbalance);
  EXPECT_GT(tally.fluxes, 100);
  EXPECT_GT(tally.blocks, 50);
  EXPECT_LT(tally.imbalance, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Random, Fluxes, ::testing::Bool(),
                         [](const auto& one) { return one.param ? "Rich" : "Plain"; });

}  // namespace
}  // namespace anticrack::estimate
