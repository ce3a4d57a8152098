// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fluxes on random membranes of all kinds. With v in the discrete space of any finer mesh,
//
//   Pi(v) - |sigma - T grad v|^2 / 2 - int p_s [v] = D(sigma)
//
// does not depend on v: that holds to rounding if and only if sigma has the divergence, the
// continuity, the fluxes, resultants and moments that it must have.
#include "estimate/equilibrated_flux.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "estimate/cut_mesh.hpp"
#include "fem/triangle_rules.hpp"
#include "operators/mesh_operator.hpp"
#include "reference/random_membrane.hpp"
#include "support/mesh_quality.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

namespace anticrack::estimate {
namespace {

/// A solved membrane as the flux sees it.
struct Solved {
  std::shared_ptr<const mesh::Mesh> mesh;
  std::shared_ptr<const operators::MeshOperator> op;
  CutMesh cut;
  contact::Answer answer;
  std::vector<double> u, force;

  Solved(const mesh::Mesh& given, const fem::Load& load, const std::vector<double>& on_triangles)
      : mesh(std::make_shared<const mesh::Mesh>(given)),
        op(operators::MeshOperator::factorise(mesh, 1, {})),
        cut(cut_mesh(*mesh, ddm::cut(*mesh))) {
    fem::Load full = load;
    full.force = fem::Array{"", true, std::make_shared<const std::vector<double>>(on_triangles)};
    testing::Silent silent;
    answer = testing::solve(*op, full, contact::ActiveSetOptions{}, true, silent);
    for (const contact::Field& field : answer.fields)
      u.insert(u.end(), field.u.begin(), field.u.end());
    for (const std::int32_t triangle : cut.triangle) {
      const double third = on_triangles[at(triangle)] * mesh::area(*mesh, at(triangle)) / 3;
      force.insert(force.end(), 3, third);
    }
  }

  Vector place(std::size_t corner) const { return cut.at[at(cut.copy[corner])]; }
  double tension(std::size_t t) const {
    return mesh->tension[at(mesh->subdomain[at(cut.triangle[t])])];
  }
  Vector gradient(std::size_t t) const {
    Vector result{};
    const double area = mesh::area(*mesh, at(cut.triangle[t]));
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector p = place(3 * t + (i + 1) % 3), q = place(3 * t + (i + 2) % 3);
      const double value = u[at(cut.copy[3 * t + i])] / (2 * area);
      result[0] -= value * (q[1] - p[1]);
      result[1] += value * (q[0] - p[0]);
    }
    return result;
  }
};

std::array<double, 3> barycentric(const Solved& in, std::size_t t, const Vector& x) {
  std::array<double, 3> result{};
  const double twice = 2 * mesh::area(*in.mesh, at(in.cut.triangle[t]));
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector p = in.place(3 * t + (i + 1) % 3), q = in.place(3 * t + (i + 2) % 3);
    result[i] = ((q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0])) / twice;
  }
  return result;
}

bool presses(const Face& face) {
  return face.condition == Condition::pressed || face.condition == Condition::crack_minus;
}

/// Pi(v) - D for v the solution on a mesh that is twice as fine.
double gap(const Solved& coarse, const EquilibratedFlux& flux, const Solved& fine) {
  std::vector<std::size_t> number(coarse.cut.triangle_count());
  for (std::size_t t = 0; t < number.size(); ++t) number[at(coarse.cut.triangle[t])] = t;
  const auto parent = [&](std::size_t t) { return number[at(fine.cut.triangle[t]) / 4]; };
  double sum = 0;
  for (std::size_t t = 0; t < fine.cut.triangle_count(); ++t) {
    const std::size_t in = parent(t);
    const Vector own = fine.gradient(t), before = coarse.gradient(in);
    const double area = mesh::area(*fine.mesh, at(fine.cut.triangle[t])), tension = fine.tension(t);
    for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
      const double b = fem::rule_5.b[p], c = fem::rule_5.c[p];
      Vector x{};
      for (std::size_t d = 0; d < 2; ++d)
        x[d] = (1 - b - c) * fine.place(3 * t)[d] + b * fine.place(3 * t + 1)[d] +
               c * fine.place(3 * t + 2)[d];
      const Vector off = flux.difference(in, barycentric(coarse, in, x));
      double square = 0;
      for (std::size_t d = 0; d < 2; ++d)
        square += std::pow(off[d] + tension * (before[d] - own[d]), 2);
      sum += 0.5 * area * fem::rule_5.weight[p] * square / tension;
    }
  }
  for (const Face& face : fine.cut.faces) {
    if (!presses(face)) continue;
    const auto jump = [&](std::int32_t side, std::size_t end) {
      return fine.u[at(fine.cut.copy[3 * at(side / 3) + (at(side % 3) + 1 + end) % 3])];
    };
    const std::int32_t other = fine.cut.faces[at(face.other)].side;
    const double jumps = jump(other, 0) + jump(other, 1) - jump(face.side, 0) - jump(face.side, 1);
    // Half a face of the coarse mesh: the one on which its ends lie.
    const std::size_t in = parent(at(face.side / 3));
    for (std::size_t f = 0; f < coarse.cut.faces.size(); ++f) {
      const Face& whole = coarse.cut.faces[f];
      if (at(whole.side / 3) != in || !presses(whole)) continue;
      const auto at_end = [&](std::size_t end) {
        return barycentric(coarse, in,
                           fine.place(3 * at(face.side / 3) +
                                      (at(face.side % 3) + 1 + end) % 3))[at(whole.side % 3)];
      };
      if (std::abs(at_end(0)) + std::abs(at_end(1)) > 1e-9) continue;
      const double pressure = -(flux.through_faces()[2 * f] + flux.through_faces()[2 * f + 1]);
      sum += pressure * jumps / 4;
    }
  }
  return sum;
}

struct Tally {
  int fluxes = 0, without = 0, unsolved = 0;
  double identity = 0, pull = 0, imbalance = 0;
};

void check(unsigned seed, bool rich, Tally& tally) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  reference::RandomMembrane membrane(seed, rich);
  const mesh::Mesh mesh = membrane.mesh(), finer = mesh::refine_uniform(mesh);
  std::vector<double> force, finer_force;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    force.push_back(membrane.uniform(-1, 1));
    finer_force.insert(finer_force.end(), 4, force.back());
  }
  fem::Load load;
  load.name = "random";
  load.boundary_value = std::to_string(membrane.uniform(-1, 1)) + "*x - 0.4*y";
  const std::vector<char> tilts = reference::tilting(mesh);
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    load.inclusion_forces[mesh.inclusions[j]] = membrane.uniform(-3, 3);
    if (tilts[j] != 0)
      load.inclusion_moments[mesh.inclusions[j]] = {membrane.uniform(-1, 1),
                                                    membrane.uniform(-1, 1)};
  }
  std::optional<Solved> coarse, fine;
  try {
    coarse.emplace(mesh, load, force);
    fine.emplace(finer, load, finer_force);
  } catch (const errors::Error&) {  // nothing holds a part, or no solution
    ++tally.unsolved;
    return;
  }
  if (coarse->answer.status != contact::Status::converged ||
      fine->answer.status != contact::Status::converged) {
    ++tally.unsolved;
    return;
  }
  if (!coarse->cut.obstacle.empty()) {
    ++tally.without;
    return;
  }
  ++tally.fluxes;
  const EquilibratedFlux flux(coarse->cut, {coarse->u, coarse->force, {}});
  double half = 0;
  for (const double one : flux.distance()) half += 0.5 * one;
  for (const double one : flux.work_of_pressure()) half += one;
  const double dual = coarse->answer.energy - half;
  const double from_fine = fine->answer.energy - gap(*coarse, flux, *fine);
  const double scale = std::abs(coarse->answer.energy) + flux.norm_squared();
  tally.identity = std::max(tally.identity, std::abs(dual - from_fine) / scale);
  EXPECT_LT(std::abs(dual - from_fine), 1e-9 * scale)
      << dual << " " << from_fine << " Pi " << coarse->answer.energy << " " << fine->answer.energy;
  double largest = 1e-12;
  for (const double w : flux.through_faces()) largest = std::max(largest, std::abs(w));
  for (std::size_t f = 0; f < coarse->cut.faces.size(); ++f)
    if (presses(coarse->cut.faces[f]))
      for (const std::size_t end : {0, 1})
        tally.pull = std::max(tally.pull, flux.through_faces()[2 * f + end] / largest);
  tally.imbalance = std::max(tally.imbalance, flux.imbalance() / largest);
  EXPECT_LT(dual, fine->answer.energy + 1e-12 * scale);
}

class Fluxes : public ::testing::TestWithParam<bool> {};

TEST_P(Fluxes, AreInEquilibriumOnRandomMembranes) {
  const auto given = static_cast<unsigned>(::testing::GTEST_FLAG(random_seed));
  const unsigned first = given > 0 ? given : std::random_device{}() % 99'000 + 1;
  Tally tally;
  for (unsigned k = 0; k < 200; ++k) check(first + k, GetParam(), tally);
  std::printf(
      "[ figures  ] seeds from %u: %d fluxes, %d without, %d unsolved; identity %.1e, pull %.1e, "
      "imbalance %.1e\n",
      first, tally.fluxes, tally.without, tally.unsolved, tally.identity, tally.pull,
      tally.imbalance);
  EXPECT_GT(tally.fluxes, 100);
  EXPECT_LT(tally.pull, 1e-10);
  EXPECT_LT(tally.imbalance, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Random, Fluxes, ::testing::Bool(),
                         [](const auto& one) { return one.param ? "Rich" : "Plain"; });

}  // namespace
}  // namespace anticrack::estimate
