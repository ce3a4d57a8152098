// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/decomposition.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "errors/errors.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::ddm {
namespace {

using errors::Reason;
using mesh::Kind;
using ::testing::HasSubstr;

const NodePair& pair_at(const Decomposition& decomposition, std::size_t interface,
                        std::size_t node) {
  return decomposition.pairs.at(
      static_cast<std::size_t>(decomposition.interface_pairs.at(interface).at(node)));
}

void expect_refused(const mesh::Mesh& mesh, Reason reason, const char* part_of_message) {
  try {
    cut(mesh);
    FAIL() << "accepted";
  } catch (const errors::Error& error) {
    EXPECT_EQ(error.reason(), reason) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(part_of_message));
  }
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

TEST(Cut, TiesTipsToTheInclusion) {
  const Decomposition decomposition = cut(testing::structured_mesh());
  ASSERT_EQ(decomposition.pairs.size(), 15U);
  EXPECT_EQ(decomposition.interface_pairs[0].front(), -1);
  EXPECT_EQ(decomposition.interface_pairs[0].back(), -1);
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
  EXPECT_EQ(decomposition.inclusion_subdomain[0], 0);
}

TEST(Cut, RefusesASubdomainWithoutDirichletNodes) {
  mesh::Mesh mesh = testing::structured_mesh();
  std::erase_if(mesh.dirichlet, [&mesh](const std::array<std::int32_t, 2>& edge) {
    const auto y = [&mesh](std::int32_t node) {
      return mesh.xy[2 * static_cast<std::size_t>(node) + 1];
    };
    return y(edge[0]) >= 0 && y(edge[1]) >= 0;
  });
  // The ends of the interface stay Dirichlet nodes of the lower half and hold the upper one too.
  EXPECT_NO_THROW(cut(mesh));
  std::erase_if(mesh.dirichlet, [&mesh](const std::array<std::int32_t, 2>& edge) {
    return std::abs(mesh.xy[2 * static_cast<std::size_t>(edge[0])]) == 1 &&
           std::abs(mesh.xy[2 * static_cast<std::size_t>(edge[1])]) == 1;
  });
  expect_refused(mesh, Reason::numerical, "\"upper\" has a part without Dirichlet nodes");
}

TEST(Cut, RefusesACrackThatTouchesTheDirichletBoundary) {
  mesh::Mesh mesh = testing::structured_mesh({16, 4, [](double) { return Kind::crack; }, {}, {}});
  expect_refused(mesh, Reason::not_implemented, "touches the Dirichlet boundary at (-1, 0)");
  // On a free boundary a crack may end.
  mesh.interfaces[0].kind.back() = Kind::glue;
  std::erase_if(mesh.dirichlet, [&mesh](const std::array<std::int32_t, 2>& edge) {
    return mesh.xy[2 * static_cast<std::size_t>(edge[0])] == -1 &&
           mesh.xy[2 * static_cast<std::size_t>(edge[1])] == -1;
  });
  const Decomposition decomposition = cut(mesh);
  EXPECT_EQ(pair_at(decomposition, 0, 0).kind, Kind::crack);
}

TEST(Cut, RefusesTwoInclusionsInOneNode) {
  const auto kind = [](double x) { return std::abs(x) < 0.5 ? Kind::inclusion : Kind::glue; };
  const auto inclusion = [](double x) { return x < 0 ? 0 : 1; };
  expect_refused(testing::structured_mesh({16, 4, kind, inclusion, {"one", "two"}}),
                 Reason::not_implemented, "\"one\" and \"two\" share the node at (0, 0)");
}

TEST(Cut, RefusesAnInclusionWithoutEdges) {
  expect_refused(testing::structured_mesh({16, 4, {}, {}, {"there", "missing"}}),
                 Reason::mesh_invalid, "\"missing\"");
}

TEST(Cut, RefusesAnInclusionWithItsPlusSideInTwoSubdomains) {
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
  EXPECT_NO_THROW(cut(mesh));
  std::reverse(mesh.interfaces[1].nodes.begin(), mesh.interfaces[1].nodes.end());
  std::reverse(mesh.interfaces[1].kind.begin(), mesh.interfaces[1].kind.end());
  std::reverse(mesh.interfaces[1].inclusion.begin(), mesh.interfaces[1].inclusion.end());
  expect_refused(mesh, Reason::not_implemented, "lies in two subdomains (\"upper\" and");
}

TEST(Cut, RefusesACrackAtACrossPoint) {
  // The upper half in two: at (0, 0) three subdomains meet.
  mesh::Mesh mesh = testing::structured_mesh({16, 4, [](double) { return Kind::glue; }, {}, {}});
  mesh.subdomains.emplace_back("upper right");
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double x = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      x += mesh.xy[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k])];
    }
    if (mesh.subdomain[t] == 1 && x > 0) {
      mesh.subdomain[t] = 2;
    }
  }
  mesh::Interface wall{"wall", {}, {}, {}};
  for (int j = 4; j <= 8; ++j) {
    wall.nodes.push_back(j * 17 + 8);
  }
  wall.kind.assign(4, Kind::glue);
  wall.inclusion.assign(4, -1);
  mesh.interfaces.push_back(wall);
  EXPECT_EQ(cut(mesh).pairs.size(), 15U + 2 + 3);  // three couples of neighbours in (0, 0)

  mesh.interfaces[0].kind[8] = Kind::crack;
  expect_refused(mesh, Reason::not_implemented, "reaches the point (0, 0) where interfaces meet");
}

}  // namespace
}  // namespace anticrack::ddm
