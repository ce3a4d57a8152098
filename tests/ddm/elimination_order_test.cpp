// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/elimination_order.hpp"

#include <gtest/gtest.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "base/at.hpp"
#include "ddm/cut_steps.hpp"
#include "ddm/vertex_separator.hpp"

namespace anticrack::ddm {
namespace {

using Edges = std::vector<std::pair<std::int32_t, std::int32_t>>;
using Sparse = Eigen::SparseMatrix<double>;

Graph graph_of(std::size_t n, const Edges& edges) {
  std::vector<std::vector<std::int32_t>> neighbours(n);
  for (const auto& [a, b] : edges) {
    neighbours[at(a)].push_back(b);
    neighbours[at(b)].push_back(a);
  }
  Graph graph;
  for (const auto& of_vertex : neighbours) {
    graph.neighbour.insert(graph.neighbour.end(), of_vertex.begin(), of_vertex.end());
    graph.begin.push_back(static_cast<std::int32_t>(graph.neighbour.size()));
  }
  return graph;
}

/// A square of `side` nodes a side, in triangles.
struct Square {
  explicit Square(std::int32_t side) {
    for (std::int32_t j = 0; j < side; ++j) {
      for (std::int32_t i = 0; i < side; ++i) {
        const std::int32_t a = j * side + i;
        xy.push_back(i);
        xy.push_back(j);
        if (i + 1 < side) edges.emplace_back(a, a + 1);
        if (j + 1 < side) edges.emplace_back(a, a + side);
        if (i + 1 < side && j + 1 < side) edges.emplace_back(a, a + side + 1);
      }
    }
  }
  std::size_t size() const { return xy.size() / 2; }
  Edges edges;
  std::vector<double> xy;
};

Sparse matrix_of(std::size_t n, const Edges& edges) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < n; ++i) {
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), static_cast<double>(n));
  }
  for (const auto& [a, b] : edges) {
    entries.emplace_back(a, b, -1);
    entries.emplace_back(b, a, -1);
  }
  Sparse matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Entries of the Cholesky factor.
Eigen::Index fill(const Sparse& matrix, const std::vector<std::int32_t>& order) {
  Eigen::PermutationMatrix<Eigen::Dynamic> place(matrix.rows());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place.indices()[order[i]] = static_cast<int>(i);
  }
  const Sparse ordered = place * matrix * place.transpose();
  return Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>>(ordered)
      .matrixL()
      .nestedExpression()
      .nonZeros();
}

std::vector<std::int32_t> minimum_degree(const Sparse& matrix) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(matrix, order);
  return {order.indices().begin(), order.indices().end()};
}

void expect_permutation(std::vector<std::int32_t> order, std::size_t n) {
  std::sort(order.begin(), order.end());
  std::vector<std::int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

TEST(NestedDissection, OfASquareFillsNoMoreThanMinimumDegree) {
  const Square square(70);
  const Sparse matrix = matrix_of(square.size(), square.edges);
  const auto order = nested_dissection(graph_of(square.size(), square.edges), square.xy);
  expect_permutation(order, square.size());
  EXPECT_LT(fill(matrix, order), fill(matrix, minimum_degree(matrix)));
}

TEST(NestedDissection, OfAMeshGradedToAPointFillsNoMoreThanMinimumDegree) {
  Square square(70);
  for (double& x : square.xy) {
    x = std::pow(1.5, x);  // finer by the factor 1e12 at one corner than at the other
  }
  const Sparse matrix = matrix_of(square.size(), square.edges);
  const auto order = nested_dissection(graph_of(square.size(), square.edges), square.xy);
  EXPECT_LT(fill(matrix, order), fill(matrix, minimum_degree(matrix)));
}

TEST(NestedDissection, IsTheSameForTheSameMesh) {
  const Square square(40);
  const Graph graph = graph_of(square.size(), square.edges);
  EXPECT_EQ(nested_dissection(graph, square.xy), nested_dissection(graph, square.xy));
}

TEST(NestedDissection, IsTheSameOnAnyNumberOfThreads) {
  Square square(70);
  for (double& x : square.xy) x = std::pow(1.5, x);
  const Graph mesh = graph_of(square.size(), square.edges);
  Edges star;
  for (std::int32_t b = 1; b < 200; ++b) star.emplace_back(0, b);
  const Graph no_mesh = graph_of(200, star);
  for (const int threads : {2, 3, 16}) {
    EXPECT_EQ(nested_dissection(mesh, square.xy, threads), nested_dissection(mesh, square.xy));
    EXPECT_EQ(nested_dissection(no_mesh, square.xy, threads),
              nested_dissection(no_mesh, square.xy));
    EXPECT_EQ(nested_dissection(Graph{}, {}, threads), nested_dissection(Graph{}, {}));
  }
}

TEST(NestedDissection, OfWhatIsNoMeshIsStillAnOrder) {
  expect_permutation(nested_dissection(Graph{}, {}), 0);
  expect_permutation(nested_dissection(graph_of(1, {}), std::vector<double>{1, 2}), 1);
  // Without edges; all in one place; each joined to each; all joined to one.
  std::vector<double> line(400);
  std::iota(line.begin(), line.end(), 0.0);
  expect_permutation(nested_dissection(graph_of(200, {}), line), 200);
  const Square square(20);
  const Graph graph = graph_of(square.size(), square.edges);
  expect_permutation(nested_dissection(graph, std::vector<double>(800, 0.5)), 400);
  Edges complete, star;
  for (std::int32_t b = 0; b < 200; ++b) {
    for (std::int32_t a = 0; a < b; ++a) complete.emplace_back(a, b);
    if (b != 77) star.emplace_back(77, b);
  }
  expect_permutation(nested_dissection(graph_of(200, complete), line), 200);
  const auto order = nested_dissection(graph_of(200, star), line);
  expect_permutation(order, 200);
  EXPECT_LT(fill(matrix_of(200, star), order), 2 * 200 + 64);
}

TEST(NestedDissection, OfTwoSquaresThatShareNothingIsThatOfEach) {
  const Square square(30);
  Edges edges = square.edges;
  std::vector<double> xy = square.xy;
  for (const auto& [a, b] : square.edges) edges.emplace_back(a + 900, b + 900);
  for (std::size_t i = 0; i < 900; ++i) {
    xy.push_back(square.xy[2 * i] + 100);
    xy.push_back(square.xy[2 * i + 1]);
  }
  const auto order = nested_dissection(graph_of(1800, edges), xy);
  expect_permutation(order, 1800);
  const auto alone = nested_dissection(graph_of(900, square.edges), square.xy);
  EXPECT_LT(static_cast<double>(fill(matrix_of(1800, edges), order)),
            2.1 * static_cast<double>(fill(matrix_of(900, square.edges), alone)));
}

/// The last unknowns are not ordered, and the lower triangle is all there is.
TEST(EliminationOrder, IsOfTheInteriorAndReadsTheLowerTriangle) {
  const Square square(40);
  const Sparse matrix = matrix_of(square.size(), square.edges);
  const Sparse lower = matrix.triangularView<Eigen::Lower>();
  const Eigen::Index interior = matrix.rows() - 40;
  const auto order = elimination_order(lower, interior, square.xy);
  expect_permutation(order, static_cast<std::size_t>(interior));
  const Sparse inner = matrix.topLeftCorner(interior, interior);
  EXPECT_LT(static_cast<double>(fill(inner, order)),
            1.1 * static_cast<double>(fill(inner, minimum_degree(inner))));
  expect_permutation(elimination_order(Sparse(3, 3), 0, {}), 0);
}

TEST(MinimumDegree, OfATreeFillsNothing) {
  SmallGraph tree;
  tree.size = SmallGraph::most;
  Edges edges;
  for (std::int32_t v = 1; v < 64; ++v) edges.emplace_back((v - 1) / 2, v);
  for (std::size_t v = 0; v < 64; ++v) tree.inside[v] = std::uint64_t{1} << v;
  for (const auto& [a, b] : edges) {
    tree.inside[at(a)] |= std::uint64_t{1} << b;
    tree.inside[at(b)] |= std::uint64_t{1} << a;
  }
  std::array<std::int32_t, SmallGraph::most> order{};
  minimum_degree(tree, order);
  expect_permutation({order.begin(), order.end()}, 64);
  EXPECT_EQ(fill(matrix_of(64, edges), {order.begin(), order.end()}), 64 + 63);
}

TEST(MinimumDegree, CountsTheNeighboursThatStay) {
  SmallGraph pair;
  pair.size = 2;
  pair.inside = {3, 3};
  pair.around = {7, 1};
  std::array<std::int32_t, SmallGraph::most> order{};
  minimum_degree(pair, order);
  EXPECT_EQ(order[0], 1);
  EXPECT_EQ(order[1], 0);
}

/// Every way from the first side meets `without` before the second.
bool parts(const Band& band, const std::vector<char>& without) {
  std::vector<std::int32_t> open;
  std::vector<char> seen = without;
  const auto reach = [&](std::size_t v) {
    if (seen[v] == 0) {
      seen[v] = 1;
      open.push_back(static_cast<std::int32_t>(v));
    }
  };
  for (std::size_t v = 0; v < band.size(); ++v) {
    if (band.meets_first[v] != 0) reach(v);
  }
  while (!open.empty()) {
    const std::size_t v = at(open.back());
    open.pop_back();
    if (band.meets_second[v] != 0) return false;
    for (std::int32_t e = band.begin[v]; e < band.begin[v + 1]; ++e) {
      reach(at(band.neighbour[at(e)]));
    }
  }
  return true;
}

std::size_t smallest(const Band& band) {
  std::size_t least = band.size();
  for (std::uint32_t set = 0; set < (1U << band.size()); ++set) {
    std::vector<char> without(band.size());
    for (std::size_t v = 0; v < band.size(); ++v) {
      without[v] = static_cast<char>((set >> v) & 1U);
    }
    if (static_cast<std::size_t>(std::popcount(set)) < least && parts(band, without)) {
      least = static_cast<std::size_t>(std::popcount(set));
    }
  }
  return least;
}

/// Against all subsets, for both choices of the side that the separator is to be near to.
TEST(VertexSeparator, IsTheSmallestOfRandomGraphs) {
  std::mt19937 random(5);
  VertexSeparator separator;
  std::size_t found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t n = 2 + random() % 9;
    Edges edges;
    for (std::int32_t b = 0; at(b) < n; ++b) {
      for (std::int32_t a = 0; a < b; ++a) {
        if (random() % 3 == 0) edges.emplace_back(a, b);
      }
    }
    const Graph graph = graph_of(n, edges);
    Band band{graph.begin, graph.neighbour, std::vector<char>(n), std::vector<char>(n)};
    for (std::size_t v = 0; v < n; ++v) {
      band.meets_first[v] = random() % 3 == 0 ? 1 : 0;
      band.meets_second[v] = random() % 3 == 0 ? 1 : 0;
    }
    const std::size_t least = smallest(band);
    found += least;
    for (const std::ptrdiff_t first : {0, 1000}) {
      const std::vector<Part>& part = separator.find(band, first, 500);
      std::vector<char> without(n);
      std::size_t size = 0;
      for (std::size_t v = 0; v < n; ++v) {
        without[v] = part[v] == Part::separator ? 1 : 0;
        size += part[v] == Part::separator ? 1 : 0;
        EXPECT_FALSE(part[v] == Part::second && band.meets_first[v] != 0);
        EXPECT_FALSE(part[v] == Part::first && band.meets_second[v] != 0);
      }
      for (const auto& [a, b] : edges) {
        EXPECT_FALSE(part[at(a)] == Part::first && part[at(b)] == Part::second);
        EXPECT_FALSE(part[at(a)] == Part::second && part[at(b)] == Part::first);
      }
      EXPECT_TRUE(parts(band, without));
      EXPECT_EQ(size, least);
    }
  }
  EXPECT_GT(found, 300U);  // graphs that need parting
}

TEST(VertexSeparator, LiesWhereItLeavesTheSidesMoreEqual) {
  // A chain of five: any vertex parts it.
  Band chain;
  const Graph graph = graph_of(5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  chain.begin = graph.begin;
  chain.neighbour = graph.neighbour;
  chain.meets_first = {1, 0, 0, 0, 0};
  chain.meets_second = {0, 0, 0, 0, 1};
  VertexSeparator separator;
  EXPECT_EQ(separator.find(chain, 10, 2)[0], Part::separator);
  EXPECT_EQ(separator.find(chain, 2, 10)[4], Part::separator);
}

TEST(CurveOrder, PutsNearNodesNextToEachOther) {
  // Four clusters, numbered in turn.
  std::vector<double> xy;
  std::vector<std::int32_t> nodes;
  for (std::int32_t i = 0; i < 400; ++i) {
    xy.push_back(1e-3 * (i % 7) + (i % 2));
    xy.push_back(1e-3 * (i % 11) + (i / 2 % 2));
    nodes.push_back(i);
  }
  sort_along_curve(nodes, xy);
  int jumps = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    jumps += nodes[i] % 4 != nodes[i - 1] % 4 ? 1 : 0;
  }
  EXPECT_EQ(jumps, 3);
  expect_permutation(nodes, 400);
}

TEST(CurveOrder, OfNodesInOnePlaceOrOnALineIsAnOrder) {
  std::vector<std::int32_t> nodes = {2, 0, 1};
  sort_along_curve(nodes, std::vector<double>(6, 3.0));
  EXPECT_EQ(nodes, (std::vector<std::int32_t>{2, 0, 1}));
  sort_along_curve(nodes, std::vector<double>{0, 5, 2, 5, 1, 5});
  EXPECT_EQ(nodes, (std::vector<std::int32_t>{0, 2, 1}));
  std::vector<std::int32_t> none;
  sort_along_curve(none, {});
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace anticrack::ddm
