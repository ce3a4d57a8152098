// SPDX-License-Identifier: GPL-3.0-or-later
//
// Random interfaces on a grid of subdomains: the skeleton must be that of the really doubled mesh.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "ddm/subdomain_operator.hpp"
#include "ddm_support.hpp"
#include "doubled_mesh.hpp"
#include "support/grid_mesh.hpp"

namespace anticrack::ddm {
namespace {

using mesh::Kind;
using testing::DoubledMesh;
using testing::GridMesh;

constexpr int block = 4, columns = 3, rows = 2;

/// Walls between all blocks, of random kinds and directions, slits within the blocks, a boundary
/// that is free on some sides, random tensions and nodes moved off the grid.
class RandomMembrane {
 public:
  explicit RandomMembrane(unsigned seed)
      : _random(seed), _grid(block * columns, block * rows, names(), [](int i, int j) {
          return i / block + columns * (j / block);
        }) {
    const double left = chance(), right = chance(), bottom = chance(), top = chance();
    _grid.release([&](double x, double y) {
      return (x == 0 && left < 0.4) || (x == block * columns && right < 0.4) ||
             (y == 0 && bottom < 0.6) || (y == block * rows && top < 0.6);
    });
    const bool same_direction = chance() < 0.7;
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        const int x = block * i, y = block * j;
        if (i + 1 < columns) {
          add_wall({x + block, y}, {x + block, y + block}, same_direction);
        }
        if (j + 1 < rows) {
          add_wall({x, y + block}, {x + block, y + block}, same_direction);
        }
        if (chance() < 0.5) {
          add_slit({x, y});
        }
      }
    }
    for (double& x : _grid.mesh.xy) {
      x += 0.2 * (chance() - 0.5);
    }
    for (std::size_t s = 0; s < _grid.mesh.subdomains.size(); ++s) {
      _grid.mesh.tension.push_back(0.5 + chance());
    }
  }

  const mesh::Mesh& mesh() const { return _grid.mesh; }

 private:
  static std::vector<std::string> names() {
    std::vector<std::string> result;
    result.reserve(columns * rows);
    for (int s = 0; s < columns * rows; ++s) {
      result.push_back("block " + std::to_string(s));
    }
    return result;
  }
  double chance() { return std::uniform_real_distribution<double>(0, 1)(_random); }

  /// Kinds come in runs, as on real interfaces.
  std::vector<Kind> kinds(std::size_t count, double glue) {
    std::vector<Kind> result;
    const double crack = glue + (1 - glue) * 0.6, bonded = crack + (1 - glue) * 0.15;
    while (result.size() < count) {
      const double which = chance();
      const Kind kind = which < glue     ? Kind::glue
                        : which < crack  ? Kind::crack
                        : which < bonded ? Kind::inclusion
                                         : Kind::delaminated;
      result.insert(result.end(), chance() < 0.5 ? 1 : 2, kind);
    }
    result.resize(count);
    return result;
  }

  void add(const std::vector<GridMesh::Point>& corners, std::vector<Kind> kinds_of_edges) {
    _grid.add(corners, kinds_of_edges, static_cast<std::int32_t>(_grid.mesh.inclusions.size()));
    for (const Kind kind : kinds_of_edges) {
      if (kind == Kind::inclusion || kind == Kind::delaminated) {
        _grid.mesh.inclusions.push_back("inclusion of " + _grid.mesh.interfaces.back().name);
        break;
      }
    }
  }

  void add_wall(GridMesh::Point from, GridMesh::Point to, bool as_given) {
    std::vector<Kind> of_edges = kinds(block, 0.6);
    // Mostly without inclusions at the ends, where others may begin, and held at the boundary.
    if (chance() < 0.95) {
      const double glue = chance();
      for (const auto& [edge, node] :
           {std::pair{&of_edges.front(), from}, {&of_edges.back(), to}}) {
        *edge = chance() < glue || on_boundary(node) ? Kind::glue : Kind::crack;
      }
    }
    if (!as_given && chance() < 0.5) {
      std::swap(from, to);
    }
    add({from, to}, of_edges);
  }

  bool on_boundary(const GridMesh::Point& p) const {
    return p[0] == 0 || p[0] == block * columns || p[1] == 0 || p[1] == block * rows;
  }

  void add_slit(GridMesh::Point corner) {
    const int x = corner[0], y = corner[1];
    const std::vector<std::vector<GridMesh::Point>> shapes = {
        {{x + 1, y + 2}, {x + 3, y + 2}},
        {{x + 3, y + 3}, {x + 1, y + 1}},
        {{x + 1, y + 1}, {x + 3, y + 1}, {x + 3, y + 3}},
        {{x + 2, y}, {x + 2, y + 3}},
        {{x, y + 2}, {x + 2, y + 2}},
        {{x + 1, y + 1}, {x + 1, y + 3}, {x + 3, y + 3}, {x + 3, y + 1}, {x + 1, y + 1}}};
    const std::vector<std::size_t> edges = {2, 2, 4, 3, 2, 8};
    const auto which = static_cast<std::size_t>(chance() * static_cast<double>(shapes.size()));
    add(shapes[which], kinds(edges[which], 0));
  }

  std::mt19937 _random;
  GridMesh _grid;
};

/// Inclusions that share nodes, and what touches the Dirichlet boundary: the doubled mesh knows
/// neither.
bool beyond_the_doubled_mesh(const mesh::Mesh& mesh) {
  std::map<std::int32_t, std::int32_t> inclusion_at;
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (std::size_t e = 0; e < interface.kind.size(); ++e) {
      for (const std::int32_t node : {interface.nodes[e], interface.nodes[e + 1]}) {
        const std::int32_t j = interface.inclusion[e];
        if (j >= 0 && inclusion_at.try_emplace(node, j).first->second != j) {
          return true;
        }
        for (const auto& edge : mesh.dirichlet) {
          if (interface.kind[e] != Kind::glue && (edge[0] == node || edge[1] == node)) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

/// Value of the doubled mesh of each unknown; fails unless they correspond one to one.
std::vector<int> match(const Decomposition& decomposition, const DoubledMesh& doubled,
                       std::size_t inclusions) {
  std::vector<int> value(decomposition.skeleton.unknowns, -1);
  const auto set = [&value](std::size_t unknown, int v) {
    EXPECT_TRUE(value.at(unknown) < 0 || value.at(unknown) == v);
    value.at(unknown) = v;
  };
  for (std::size_t j = 0; j < inclusions; ++j) {
    set(j, doubled.value[j]);
  }
  for (const Subdomain& subdomain : decomposition.subdomains) {
    for (std::size_t i = 0; i < subdomain.part.triangles.size(); ++i) {
      const auto node = static_cast<std::size_t>(subdomain.part.triangles[i]);
      const auto corner = 3 * static_cast<std::size_t>(subdomain.triangle[i / 3]) + i % 3;
      const int v = doubled.value[inclusions + corner];
      const bool trace = node >= subdomain.interior && node < subdomain.free();
      EXPECT_EQ(trace, doubled.skeleton[static_cast<std::size_t>(v)] != 0);
      EXPECT_EQ(node >= subdomain.free(), doubled.fixed[static_cast<std::size_t>(v)] != 0);
      if (trace) {
        set(static_cast<std::size_t>(subdomain.unknown[node - subdomain.interior]), v);
      }
    }
  }
  EXPECT_THAT(value, ::testing::Each(::testing::Ge(0)));
  EXPECT_EQ(std::set<int>(value.begin(), value.end()).size(), value.size());
  return value;
}

void expect_same_schur(const Decomposition& decomposition, const DoubledMesh& doubled,
                       const std::vector<int>& value) {
  const auto n = static_cast<Eigen::Index>(value.size());
  Eigen::MatrixXd assembled = Eigen::MatrixXd::Zero(n, n);
  for (const Subdomain& subdomain : decomposition.subdomains) {
    const Eigen::MatrixXd schur = SubdomainOperator(subdomain).factor().schur();
    for (Eigen::Index i = 0; i < schur.rows(); ++i) {
      for (Eigen::Index j = 0; j < schur.cols(); ++j) {
        assembled(subdomain.unknown[static_cast<std::size_t>(i)],
                  subdomain.unknown[static_cast<std::size_t>(j)]) += schur(i, j);
      }
    }
  }
  const std::vector<int> position = doubled.position();
  std::vector<int> order;
  order.reserve(value.size());
  for (const int v : value) {
    order.push_back(position[static_cast<std::size_t>(v)]);
  }
  const Eigen::MatrixXd all = doubled.schur();
  ASSERT_EQ(all.rows(), n);
  const Eigen::MatrixXd expected = all(order, order);
  EXPECT_LT((assembled - expected).norm(), 1e-12 * expected.norm());
}

/// The contacts say the same as all edges together.
void expect_same_contacts(const Decomposition& decomposition, const DoubledMesh& doubled,
                          const std::vector<int>& value) {
  std::set<std::pair<int, int>> above;
  for (const Contact& contact : decomposition.skeleton.contacts) {
    above.insert({value[static_cast<std::size_t>(contact.plus)],
                  value[static_cast<std::size_t>(contact.minus)]});
  }
  EXPECT_EQ(above.size(), decomposition.skeleton.contacts.size());
  for (bool changed = true; changed;) {
    changed = false;
    const auto known = above;
    for (const auto& [a, b] : known) {
      for (const auto& [c, d] : known) {
        changed |= b == c && above.insert({a, d}).second;
      }
    }
  }
  EXPECT_EQ(above, doubled.above);
}

void expect_consistent_pairs(const Decomposition& decomposition, const DoubledMesh& doubled,
                             const std::vector<int>& value, std::size_t inclusions) {
  for (const NodePair& pair : decomposition.pairs) {
    const auto unknown = [&decomposition](std::int32_t subdomain, std::int32_t trace) {
      return decomposition.subdomains[static_cast<std::size_t>(subdomain)]
          .unknown[static_cast<std::size_t>(trace)];
    };
    const std::int32_t plus = unknown(pair.plus, pair.plus_trace);
    const std::int32_t minus = unknown(pair.minus, pair.minus_trace);
    EXPECT_EQ(pair.unilateral(), plus != minus);
    EXPECT_EQ(pair.inclusion, static_cast<std::size_t>(plus) < inclusions ? plus : -1);
    EXPECT_EQ(pair.kind == Kind::inclusion || pair.kind == Kind::delaminated, pair.inclusion >= 0);
    if (pair.unilateral()) {
      EXPECT_EQ(doubled.above.count({value[static_cast<std::size_t>(plus)],
                                     value[static_cast<std::size_t>(minus)]}),
                1U);
    }
    if (pair.contact >= 0) {
      const Contact& contact =
          decomposition.skeleton.contacts[static_cast<std::size_t>(pair.contact)];
      EXPECT_EQ(contact.plus, plus);
      EXPECT_EQ(contact.minus, minus);
    }
  }
}

TEST(Skeleton, IsThatOfTheDoubledMesh) {
  int accepted = 0, for_nodes = 0, crossings = 0, not_held = 0, contacts = 0, implied = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RandomMembrane membrane(seed);
    const mesh::Mesh& mesh = membrane.mesh();
    mesh::validate(mesh);
    std::optional<errors::Error> error;
    Decomposition decomposition;
    try {
      decomposition = cut(mesh);
    } catch (const errors::Error& caught) {
      error = caught;
    }
    if (beyond_the_doubled_mesh(mesh)) {
      ++for_nodes;
      continue;
    }
    const DoubledMesh doubled = testing::double_mesh(mesh);
    if (!doubled.held) {
      ++not_held;
      ASSERT_TRUE(error.has_value());
      EXPECT_EQ(error->reason(), errors::Reason::numerical) << error->what();
      continue;
    }
    ASSERT_FALSE(error.has_value()) << error->what();
    EXPECT_EQ(doubled.crossing, !decomposition.skeleton.dependent.empty());
    crossings += doubled.crossing ? 1 : 0;
    ++accepted;
    contacts += static_cast<int>(decomposition.skeleton.contacts.size());
    implied += static_cast<int>(
        std::count_if(decomposition.pairs.begin(), decomposition.pairs.end(),
                      [](const NodePair& pair) { return pair.unilateral() && pair.contact < 0; }));
    const std::vector<int> value = match(decomposition, doubled, mesh.inclusions.size());
    expect_same_schur(decomposition, doubled, value);
    expect_same_contacts(decomposition, doubled, value);
    expect_consistent_pairs(decomposition, doubled, value, mesh.inclusions.size());
    if (HasFailure()) {
      return;
    }
  }
  std::printf(
      "[ figures  ] %d accepted with %d contacts and %d implied, %d with dependent ones; left out: "
      "%d for what meets in a node; refused: %d for want of support\n",
      accepted, contacts, implied, crossings, for_nodes, not_held);
  EXPECT_GT(accepted, 60);
  EXPECT_GT(implied, 0);
  EXPECT_GT(crossings, 0);
  EXPECT_GT(not_held, 0);
  EXPECT_GT(for_nodes, 0);
}

}  // namespace
}  // namespace anticrack::ddm
