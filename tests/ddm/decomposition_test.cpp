// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/decomposition.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "ddm_support.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::ddm {
namespace {

using errors::Reason;
using mesh::Kind;
using testing::expect_refused;
using ::testing::HasSubstr;

const NodePair& pair_at(const Decomposition& decomposition, std::size_t interface,
                        std::size_t node) {
  return decomposition.pairs.at(
      static_cast<std::size_t>(decomposition.interface_sides.at(interface).at(node).pair));
}

TEST(Cut, NumbersInteriorThenTraceThenDirichlet) {
  const mesh::Mesh mesh = testing::structured_mesh();  // 16 columns, 4 rows a side
  const Decomposition decomposition = cut(mesh);
  ASSERT_EQ(decomposition.subdomains.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    const Subdomain& subdomain = decomposition.subdomains[s];
    EXPECT_EQ(subdomain.interior, 15U * 3);
    EXPECT_EQ(subdomain.trace, 15U);
    EXPECT_EQ(subdomain.dirichlet, 17U + 2 * 4);
    ASSERT_EQ(subdomain.node.size(), 17U * 5);
    for (std::size_t i = 0; i < subdomain.node.size(); ++i) {
      const double x = subdomain.part.xy[2 * i], y = subdomain.part.xy[2 * i + 1];
      EXPECT_EQ(x, mesh.xy[2 * static_cast<std::size_t>(subdomain.node[i])]);
      const bool boundary = std::abs(x) == 1 || std::abs(y) == 1;
      EXPECT_EQ(i >= subdomain.free(), boundary);
      EXPECT_EQ(i >= subdomain.interior && i < subdomain.free(), !boundary && y == 0);
      EXPECT_TRUE(s == 0 ? y <= 0 : y >= 0);
    }
  }
}

TEST(Cut, IsTheSameOnAnyNumberOfThreads) {
  const mesh::Mesh mesh = testing::structured_mesh({64, 32, {}, {}});
  const Decomposition one = cut(mesh), other = cut(mesh, 3);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(other.subdomains[s].node, one.subdomains[s].node);
    EXPECT_EQ(other.subdomains[s].triangle, one.subdomains[s].triangle);
    EXPECT_EQ(other.subdomains[s].part.triangles, one.subdomains[s].part.triangles);
    EXPECT_EQ(other.subdomains[s].floating, one.subdomains[s].floating);
  }
}

TEST(Cut, TiesTipsToTheInclusion) {
  const Decomposition decomposition = cut(testing::structured_mesh());
  ASSERT_EQ(decomposition.pairs.size(), 15U);
  for (const SidePair& end :
       {decomposition.interface_sides[0].front(), decomposition.interface_sides[0].back()}) {
    EXPECT_EQ(end.pair, -1);
    EXPECT_EQ(end.minus, -1);
    EXPECT_EQ(end.plus, -1);
  }
  EXPECT_EQ(decomposition.skeleton.contacts.size(), 7U);
  EXPECT_EQ(decomposition.skeleton.unknowns, 1U + 6 + 7);  // A, glue, minus side of the crack
  for (std::size_t i = 1; i < 16; ++i) {
    const NodePair& pair = pair_at(decomposition, 0, i);
    EXPECT_EQ(pair.minus, 0);
    EXPECT_EQ(pair.plus, 1);
    const double x = std::abs(-1 + 2.0 * static_cast<double>(i) / 16);
    const Kind expected = x < 0.5 ? Kind::delaminated : x == 0.5 ? Kind::inclusion : Kind::glue;
    EXPECT_EQ(pair.kind, expected) << "at " << x;
    EXPECT_EQ(pair.inclusion, x <= 0.5 ? 0 : -1);
    EXPECT_EQ(decomposition.subdomains[1].rigid[static_cast<std::size_t>(pair.plus_trace)],
              x <= 0.5 ? 0 : -1);
    EXPECT_EQ(decomposition.subdomains[0].rigid[static_cast<std::size_t>(pair.minus_trace)], -1);
    const Subdomain& lower = decomposition.subdomains[0];
    EXPECT_EQ(lower.node[lower.interior + static_cast<std::size_t>(pair.minus_trace)], pair.node);
    const std::int32_t above =
        decomposition.subdomains[1].unknown[static_cast<std::size_t>(pair.plus_trace)];
    const std::int32_t below = lower.unknown[static_cast<std::size_t>(pair.minus_trace)];
    EXPECT_EQ(above == 0, x <= 0.5);
    EXPECT_EQ(above == below, x >= 0.5);
    ASSERT_EQ(pair.contact >= 0, x < 0.5);
    if (pair.contact >= 0) {
      const Contact& contact =
          decomposition.skeleton.contacts[static_cast<std::size_t>(pair.contact)];
      EXPECT_EQ(contact.plus, above);
      EXPECT_EQ(contact.minus, below);
    }
  }
}

TEST(Cut, TakesTheStricterConditionWhereEdgesMeet) {
  const auto kind = [](double x) {
    if (x < -0.5) return Kind::glue;
    if (x < -0.25) return Kind::crack;
    if (x < 0) return Kind::delaminated;
    if (x < 0.25) return Kind::inclusion;
    return Kind::crack;
  };
  mesh::Mesh mesh = testing::structured_mesh({16, 4, kind, {}, {"bar"}});
  mesh.interfaces[0].kind.back() = Kind::glue;  // the crack must not reach the boundary
  const Decomposition decomposition = cut(mesh);
  EXPECT_EQ(pair_at(decomposition, 0, 4).kind, Kind::glue);         // glue, crack
  EXPECT_EQ(pair_at(decomposition, 0, 5).kind, Kind::crack);        // crack, crack
  EXPECT_EQ(pair_at(decomposition, 0, 6).kind, Kind::delaminated);  // crack, delaminated
  EXPECT_EQ(pair_at(decomposition, 0, 8).kind, Kind::inclusion);    // delaminated, bonded
  EXPECT_EQ(pair_at(decomposition, 0, 10).kind, Kind::inclusion);   // bonded, crack
  EXPECT_EQ(pair_at(decomposition, 0, 15).kind, Kind::glue);        // crack, glue
  EXPECT_EQ(pair_at(decomposition, 0, 10).inclusion, 0);
  EXPECT_EQ(pair_at(decomposition, 0, 5).inclusion, -1);
}

TEST(Cut, PlusSideIsOnTheLeftOfTheInterface) {
  mesh::Mesh mesh = testing::structured_mesh();
  mesh::Interface& interface = mesh.interfaces[0];
  std::reverse(interface.nodes.begin(), interface.nodes.end());
  const Decomposition decomposition = cut(mesh);
  EXPECT_EQ(decomposition.pairs.front().plus, 0);
  EXPECT_EQ(decomposition.pairs.front().minus, 1);
  EXPECT_EQ(decomposition.subdomains[0].rigid[7], 0);
  EXPECT_EQ(decomposition.subdomains[1].rigid[7], -1);
}

TEST(Cut, HoldsTheMembraneByAnyDirichletNode) {
  mesh::Mesh mesh = testing::structured_mesh();
  std::erase_if(mesh.dirichlet, [&mesh](const std::array<std::int32_t, 2>& edge) {
    const auto y = [&mesh](std::int32_t node) {
      return mesh.xy[2 * static_cast<std::size_t>(node) + 1];
    };
    return y(edge[0]) >= 0 && y(edge[1]) >= 0;
  });
  // The ends of the interface stay Dirichlet nodes of the lower half and hold the upper one too.
  const Decomposition held = cut(mesh);
  EXPECT_TRUE(held.subdomains[1].floating.empty());
  EXPECT_EQ(uzawa_obstacle(held, mesh), "");
  std::erase_if(mesh.dirichlet, [&mesh](const std::array<std::int32_t, 2>& edge) {
    return std::abs(mesh.xy[2 * static_cast<std::size_t>(edge[0])]) == 1 &&
           std::abs(mesh.xy[2 * static_cast<std::size_t>(edge[1])]) == 1;
  });
  const Decomposition floating = cut(mesh);
  EXPECT_EQ(floating.subdomains[0].floating.size(), 0U);
  EXPECT_EQ(floating.subdomains[1].floating.size(), 1U);
  EXPECT_THAT(uzawa_obstacle(floating, mesh), HasSubstr("\"upper\" has a part without Dirichlet"));
  EXPECT_THAT(uzawa_obstacle(floating, mesh), HasSubstr("active-set"));
  mesh.dirichlet.clear();
  expect_refused(mesh, Reason::numerical, "nothing holds the subdomain \"lower\"");
}

TEST(Cut, ACrackMayReachTheBoundary) {
  mesh::Mesh mesh = testing::structured_mesh({16, 4, [](double) { return Kind::crack; }, {}, {}});
  const Decomposition held = cut(mesh);
  EXPECT_EQ(held.skeleton.contacts.size(),
            15U);  // its ends have the boundary's value on both sides
  EXPECT_EQ(held.interface_sides[0].front().pair, -1);
  mesh.interfaces[0].kind.back() = Kind::glue;
  std::erase_if(mesh.dirichlet, [&mesh](const std::array<std::int32_t, 2>& edge) {
    return mesh.xy[2 * static_cast<std::size_t>(edge[0])] == -1 &&
           mesh.xy[2 * static_cast<std::size_t>(edge[1])] == -1;
  });
  const Decomposition decomposition = cut(mesh);
  EXPECT_EQ(pair_at(decomposition, 0, 0).kind, Kind::crack);
}

TEST(Cut, AnInclusionThatReachesTheDirichletBoundaryIsHeldThere) {
  const auto kind = [](double x) { return x < 0.5 ? Kind::inclusion : Kind::glue; };
  mesh::Mesh mesh = testing::structured_mesh({16, 4, kind, {}, {"bar"}});
  const Skeleton held = cut(mesh).skeleton;
  ASSERT_EQ(held.held.size(), 1U);
  EXPECT_GE(held.held[0].subdomain, 0);
  EXPECT_TRUE(held.rows[0].free.empty());  // A is the boundary's value
  mesh.motions = {{true, {}}};
  const Skeleton hinged = cut(mesh).skeleton;
  EXPECT_EQ(hinged.held.size(), 1U);
  EXPECT_EQ(hinged.rows[0].free.size() + hinged.rows[1].free.size(), 2U);  // it turns about its end
}

TEST(Cut, RefusesAnInclusionWithoutEdges) {
  expect_refused(testing::structured_mesh({16, 4, {}, {}, {"there", "missing"}}),
                 Reason::mesh_invalid, "\"missing\"");
}

TEST(Cut, AnInclusionMayHaveItsPlusSideInTwoSubdomainsButNotForUzawa) {
  mesh::Mesh mesh = testing::structured_mesh();
  mesh::Interface right = mesh.interfaces[0];
  mesh::Interface& left = mesh.interfaces[0];
  left.nodes.resize(9);
  left.kind.resize(8);
  left.inclusion.resize(8);
  right.nodes.erase(right.nodes.begin(), right.nodes.begin() + 8);
  right.kind.erase(right.kind.begin(), right.kind.begin() + 8);
  right.inclusion.erase(right.inclusion.begin(), right.inclusion.begin() + 8);
  mesh.interfaces.push_back(right);
  EXPECT_EQ(uzawa_obstacle(cut(mesh), mesh), "");
  std::reverse(mesh.interfaces[1].nodes.begin(), mesh.interfaces[1].nodes.end());
  std::reverse(mesh.interfaces[1].kind.begin(), mesh.interfaces[1].kind.end());
  std::reverse(mesh.interfaces[1].inclusion.begin(), mesh.interfaces[1].inclusion.end());
  const Decomposition turned = cut(mesh);
  EXPECT_THAT(uzawa_obstacle(turned, mesh), HasSubstr("lies in two subdomains, \"lower\" and"));
  // Where the faces change roles both are the plus side of one edge: the node is bonded.
  EXPECT_EQ(pair_at(turned, 0, 8).kind, Kind::inclusion);
  EXPECT_EQ(turned.skeleton.contacts.size(), 6U);
}

}  // namespace
}  // namespace anticrack::ddm
