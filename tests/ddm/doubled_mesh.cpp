// SPDX-License-Identifier: GPL-3.0-or-later
#include "doubled_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace anticrack::testing {
namespace {

using mesh::Kind;

struct Edge {
  Kind kind;
  int inclusion;
};

class Doubling {
 public:
  explicit Doubling(const mesh::Mesh& mesh)
      : _mesh(mesh),
        _inclusions(static_cast<int>(mesh.inclusions.size())),
        _label(mesh.inclusions.size() + mesh.triangles.size()) {
    std::iota(_label.begin(), _label.end(), 0);
    for (const mesh::Interface& interface : mesh.interfaces) {
      for (std::size_t e = 0; e < interface.kind.size(); ++e) {
        _edges[{interface.nodes[e], interface.nodes[e + 1]}] = {interface.kind[e],
                                                                interface.inclusion[e]};
        _on_interface.insert({interface.nodes[e], interface.nodes[e + 1]});
      }
    }
    for (const auto& edge : mesh.dirichlet) {
      _fixed_nodes.insert({edge[0], edge[1]});
    }
  }

  DoubledMesh run() {
    merge_neighbours();
    merge_dirichlet();
    std::set<std::pair<int, int>> above = closure();
    for (bool changed = true; changed; above = closure()) {
      changed = false;
      for (const auto& [upper, lower] : above) {
        if (above.count({lower, upper}) > 0) {
          changed |= merge(upper, lower);
        }
      }
    }
    return number(above);
  }

 private:
  int corner(std::size_t triangle, int node) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (_mesh.triangles[3 * triangle + k] == node) {
        return _inclusions + static_cast<int>(3 * triangle + k);
      }
    }
    return -1;
  }
  int label(int member) const { return _label[static_cast<std::size_t>(member)]; }
  bool merge(int a, int b) {
    const int from = std::max(label(a), label(b)), to = std::min(label(a), label(b));
    std::replace(_label.begin(), _label.end(), from, to);
    return from != to;
  }

  /// Calls `visit(a, b, left, right)` for each directed edge a -> b between two triangles.
  template <class Visit>
  void each_edge(Visit&& visit) const {
    std::map<std::pair<int, int>, std::size_t> left;
    for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        left[{_mesh.triangles[3 * t + k], _mesh.triangles[3 * t + (k + 1) % 3]}] = t;
      }
    }
    for (const auto& [edge, t] : left) {
      const auto right = left.find({edge.second, edge.first});
      if (right != left.end()) {
        visit(edge.first, edge.second, t, right->second);
      }
    }
  }

  void merge_neighbours() {
    each_edge([this](int a, int b, std::size_t left, std::size_t right) {
      const auto cut = _edges.find({a, b});
      if (cut == _edges.end() && _edges.count({b, a}) > 0) {
        return;  // comes up the other way round
      }
      for (const int node : {a, b}) {
        const int plus = corner(left, node), minus = corner(right, node);
        if (cut == _edges.end() || cut->second.kind == Kind::glue) {
          merge(plus, minus);
        } else if (cut->second.kind != Kind::crack) {
          merge(plus, cut->second.inclusion);
          if (cut->second.kind == Kind::inclusion) {
            merge(minus, cut->second.inclusion);
          }
        }
      }
    });
  }

  void merge_dirichlet() {
    std::map<int, int> first;
    for (std::size_t c = 0; c < _mesh.triangles.size(); ++c) {
      const int node = _mesh.triangles[c], member = _inclusions + static_cast<int>(c);
      if (_fixed_nodes.count(node) > 0 || _on_interface.count(node) == 0) {
        merge(first.try_emplace(node, member).first->second, member);
      }
    }
  }

  std::set<std::pair<int, int>> closure() const {
    std::set<std::pair<int, int>> above;
    each_edge([&](int a, int b, std::size_t left, std::size_t right) {
      const auto cut = _edges.find({a, b});
      if (cut == _edges.end()) {
        return;
      }
      for (const int node : {a, b}) {
        const int plus = label(corner(left, node)), minus = label(corner(right, node));
        if (plus != minus) {
          above.insert({plus, minus});
        }
      }
    });
    for (bool changed = true; changed;) {
      changed = false;
      const auto known = above;
      for (const auto& [a, b] : known) {
        for (auto next = known.lower_bound({b, -1}); next != known.end() && next->first == b;
             ++next) {
          changed |= a != next->second && above.insert({a, next->second}).second;
        }
      }
    }
    return above;
  }

  DoubledMesh number(const std::set<std::pair<int, int>>& above) const {
    DoubledMesh result;
    std::map<int, int> of_label;
    for (const int member : _label) {
      of_label.try_emplace(member, static_cast<int>(of_label.size()));
    }
    for (const int member : _label) {
      result.value.push_back(of_label[member]);
    }
    result.values = of_label.size();
    for (const auto& [a, b] : above) {
      result.above.insert({of_label[a], of_label[b]});
    }
    result.fixed.assign(result.values, 0);
    result.skeleton.assign(result.values, 0);
    std::fill_n(result.skeleton.begin(), _inclusions, 1);
    for (std::size_t c = 0; c < _mesh.triangles.size(); ++c) {
      const auto value =
          static_cast<std::size_t>(result.value[static_cast<std::size_t>(_inclusions) + c]);
      result.fixed[value] |= static_cast<char>(_fixed_nodes.count(_mesh.triangles[c]));
      result.skeleton[value] |= static_cast<char>(_on_interface.count(_mesh.triangles[c]));
    }
    for (std::size_t v = 0; v < result.values; ++v) {
      result.skeleton[v] = static_cast<char>(result.skeleton[v] != 0 && result.fixed[v] == 0);
    }
    assemble(result);
    look_for_crossings(result);
    look_for_support(result);
    return result;
  }

  void assemble(DoubledMesh& result) const {
    const auto n = static_cast<Eigen::Index>(result.values);
    result.stiffness = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
      Eigen::Matrix3d vandermonde;
      std::array<int, 3> value{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto node = static_cast<std::size_t>(_mesh.triangles[3 * t + k]);
        vandermonde.row(static_cast<Eigen::Index>(k)) << 1, _mesh.xy[2 * node],
            _mesh.xy[2 * node + 1];
        value[k] = result.value[static_cast<std::size_t>(_inclusions) + 3 * t + k];
      }
      const Eigen::Matrix<double, 2, 3> gradient = vandermonde.inverse().bottomRows<2>();
      const double tension =
          _mesh.tension.empty() ? 1 : _mesh.tension[static_cast<std::size_t>(_mesh.subdomain[t])];
      const Eigen::Matrix3d element =
          tension * vandermonde.determinant() / 2 * gradient.transpose() * gradient;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          result.stiffness(value[static_cast<std::size_t>(a)],
                           value[static_cast<std::size_t>(b)]) += element(a, b);
        }
      }
    }
  }

  /// Edges of the transitive reduction against those of a forest on the same values.
  static void look_for_crossings(DoubledMesh& result) {
    std::vector<int> tree(result.values);
    std::iota(tree.begin(), tree.end(), 0);
    for (const auto& [a, b] : result.above) {
      bool implied = false;
      for (const auto& [from, between] : result.above) {
        implied |= from == a && result.above.count({between, b}) > 0;
      }
      if (implied) {
        continue;
      }
      const int one = tree[static_cast<std::size_t>(a)], other = tree[static_cast<std::size_t>(b)];
      result.crossing |= one == other;
      std::replace(tree.begin(), tree.end(), one, other);
    }
  }

  void look_for_support(DoubledMesh& result) const {
    std::vector<char> held = result.fixed;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
        const int* value = &result.value[static_cast<std::size_t>(_inclusions) + 3 * t];
        bool any = false, all = true;
        for (int k = 0; k < 3; ++k) {
          any |= held[static_cast<std::size_t>(value[k])] != 0;
          all &= held[static_cast<std::size_t>(value[k])] != 0;
        }
        if (any && !all) {
          changed = true;
          for (int k = 0; k < 3; ++k) {
            held[static_cast<std::size_t>(value[k])] = 1;
          }
        }
      }
    }
    result.held = std::count(held.begin(), held.end(), 0) == 0;
  }

  const mesh::Mesh& _mesh;
  int _inclusions;
  std::vector<int> _label;
  std::map<std::pair<int, int>, Edge> _edges;
  std::set<int> _on_interface, _fixed_nodes;
};

}  // namespace

std::vector<int> DoubledMesh::position() const {
  std::vector<int> result(values, -1);
  int count = 0;
  for (std::size_t v = 0; v < values; ++v) {
    if (skeleton[v] != 0) {
      result[v] = count++;
    }
  }
  return result;
}

Eigen::MatrixXd DoubledMesh::schur() const {
  std::vector<int> inner, outer;
  for (std::size_t v = 0; v < values; ++v) {
    if (skeleton[v] != 0) {
      outer.push_back(static_cast<int>(v));
    } else if (fixed[v] == 0) {
      inner.push_back(static_cast<int>(v));
    }
  }
  const Eigen::MatrixXd coupling = stiffness(inner, outer);
  return stiffness(outer, outer) -
         coupling.transpose() * stiffness(inner, inner).llt().solve(coupling);
}

DoubledMesh double_mesh(const mesh::Mesh& mesh) { return Doubling(mesh).run(); }

}  // namespace anticrack::testing
