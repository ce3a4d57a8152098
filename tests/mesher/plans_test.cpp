// SPDX-License-Identifier: GPL-3.0-or-later
//
// Plans written by hand, meshed by the real helper: what no geometry says so directly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/edges.hpp"
#include "mesh/quality.hpp"
#include "mesher/real_helper.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using mesh::Kind;
using mesh::Mesh;
using mesh::Plan;
using mesh::Role;

constexpr std::size_t plan_triangles = 100'000;

Mesh make_plan(const Plan& plan, std::size_t max_triangles = plan_triangles) {
  return mesher::run(testing::real_helper(), mesh::GenerateRequest{plan, max_triangles}, {});
}

/// The square (0,4) x (0,4), its sides cut into eight, the lower one Neumann; nothing in it.
Plan square_plan() {
  Plan plan;
  plan.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  plan.curves = {{0, 1, 8, Role::neumann, 0, -1},
                 {1, 2, 8, Role::dirichlet, 0, -1},
                 {2, 3, 8, Role::dirichlet, 0, -1},
                 {3, 0, 8, Role::dirichlet, 0, -1}};
  mesh::PlannedFace face;
  face.name = "all";
  face.tension = 3;
  face.outer = {1, 2, 3, 4};
  plan.faces = {face};
  return plan;
}

double total_area(const Mesh& mesh, std::int32_t subdomain) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.subdomain[t] == subdomain) sum += mesh::area(mesh, t);
  }
  return sum;
}

TEST(Plans, SlitSwimsInOneFace) {
  Plan plan = square_plan();
  plan.points.insert(plan.points.end(), {{1, 2}, {2, 2}, {3, 2.5}});
  plan.curves.push_back({4, 5, 4, Role::interface, 0, 0, Kind::crack, -1});
  plan.curves.push_back({5, 6, 3, Role::interface, 0, 0, Kind::crack, -1});
  plan.interfaces = {{"slit", {4, 5}}};
  plan.faces[0].embedded = {4, 5};
  const Mesh mesh = make_plan(plan);
  EXPECT_EQ(mesh.subdomains, std::vector<std::string>{"all"});
  EXPECT_EQ(mesh.tension, std::vector<double>{3});
  EXPECT_NEAR(total_area(mesh, 0), 16, 1e-12);
  EXPECT_EQ(mesh.dirichlet.size(), 24U);
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  EXPECT_EQ(mesh.interfaces[0].nodes.size(), 8U);
  EXPECT_NEAR(mesh::arc_length(mesh, mesh.interfaces[0]).back(), 1 + std::hypot(1, 0.5), 1e-14);
}

TEST(Plans, RingIsAHoleOfTheFaceAroundIt) {
  Plan plan = square_plan();
  plan.points.insert(plan.points.end(), {{1, 1}, {3, 1}, {2, 3}});
  plan.inclusions = {"rim"};
  plan.curves.push_back({4, 5, 4, Role::interface, 1, 0, Kind::delaminated, 0});
  plan.curves.push_back({5, 6, 5, Role::interface, 1, 0, Kind::glue, -1});
  plan.curves.push_back({6, 4, 6, Role::interface, 1, 0, Kind::inclusion, 0});
  plan.interfaces = {{"ring", {4, 5, 6}}};
  plan.faces[0].holes = {{-7, -6, -5}};
  mesh::PlannedFace inside;
  inside.name = "inside";
  inside.outer = {5, 6, 7};
  plan.faces.push_back(inside);
  const Mesh mesh = make_plan(plan);
  EXPECT_NEAR(total_area(mesh, 0), 14, 1e-12);
  EXPECT_NEAR(total_area(mesh, 1), 2, 1e-12);
  EXPECT_EQ(mesh.tension, (std::vector<double>{3, 1}));
  const mesh::Interface& ring = mesh.interfaces.at(0);
  EXPECT_EQ(ring.nodes.size(), 16U);
  EXPECT_EQ(ring.nodes.front(), ring.nodes.back());
  EXPECT_EQ(std::ranges::count(ring.kind, Kind::delaminated), 4);
  EXPECT_EQ(std::ranges::count(ring.kind, Kind::glue), 5);
  EXPECT_EQ(std::ranges::count(ring.inclusion, 0), 10);
}

TEST(Plans, FacesOfOneNameAreOneSubdomain) {
  Plan plan = square_plan();
  // a line to follow from side to side makes two faces
  plan.points.insert(plan.points.end(), {{0, 1}, {4, 1.5}});
  plan.curves = {{0, 1, 8, Role::dirichlet, 0, -1}, {1, 5, 3, Role::dirichlet, 0, -1},
                 {5, 2, 5, Role::dirichlet, 1, -1}, {2, 3, 8, Role::dirichlet, 1, -1},
                 {3, 4, 6, Role::dirichlet, 1, -1}, {4, 0, 2, Role::dirichlet, 0, -1},
                 {4, 5, 7, Role::align, 1, 0}};
  plan.faces[0].outer = {1, 2, -7, 6};
  plan.faces.push_back(plan.faces[0]);
  plan.faces[1].outer = {7, 3, 4, 5};
  const Mesh mesh = make_plan(plan);
  EXPECT_EQ(mesh.subdomains, std::vector<std::string>{"all"});
  EXPECT_EQ(mesh.tension, std::vector<double>{3});
  EXPECT_TRUE(mesh.interfaces.empty());
  EXPECT_EQ(mesh.dirichlet.size(), 32U);
  EXPECT_NEAR(total_area(mesh, 0), 16, 1e-12);
  // every triangle lies above the line or below it
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double above = 0;
    double below = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto n = 2 * static_cast<std::size_t>(mesh.triangles[3 * t + i]);
      const double height = mesh.xy[n + 1] - (1 + mesh.xy[n] / 8);
      above = std::max(above, height);
      below = std::max(below, -height);
    }
    ASSERT_LT(std::min(above, below), 1e-12) << "triangle " << t;
  }
}

TEST(Plans, GradingIsApplied) {
  Plan plan = square_plan();
  plan.points.insert(plan.points.end(), {{1, 2}, {3, 2}});
  plan.curves.push_back({4, 5, 4, Role::interface, 0, 0, Kind::crack, -1});
  plan.interfaces = {{"slit", {4}}};
  plan.faces[0].embedded = {4};
  plan.grading = {0.5, 0.2, 1e-3};
  const Mesh mesh = make_plan(plan);
  EXPECT_GT(mesh.interfaces[0].nodes.size(), 20U);
  EXPECT_GT(mesh.bisection_bound, 10);
  EXPECT_GE(mesh::minimum_angle(mesh), mesh.bisection_bound * (1 - 1e-9));
  EXPECT_EQ(mesh.dirichlet.size() % 8, 0U);
  EXPECT_TRUE(testing::throws([&] { make_plan(plan, mesh.triangle_count() - 1); },
                              errors::Reason::limit_exceeded, "options.size"));
}

}  // namespace
}  // namespace anticrack
