// SPDX-License-Identifier: GPL-3.0-or-later
//
// The contact problem with nothing clever: finite elements on a mesh whose nodes are really doubled
// along the interfaces, every condition written out edge by edge, and a projected solver for the
// multipliers. Shares no code with server/ddm and server/contact.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::reference {

struct MonolithicLoad {
  std::vector<double> force;  ///< per triangle
  std::function<double(double, double)> boundary;
  std::vector<double> inclusion_forces;
  std::vector<std::array<double, 2>> inclusion_moments = {};
};

class MonolithicContact {
 public:
  MonolithicContact(const mesh::Mesh& mesh, const MonolithicLoad& load);

  /// False where what holds a rigid body cannot be met together; the rest is empty then.
  bool solvable() const noexcept { return _solvable; }
  /// False where a part of the membrane is held by contact alone; the rest is empty then.
  bool held() const noexcept { return _held; }
  /// Whether the projected iteration came to rest.
  bool converged() const noexcept { return _converged; }

  /// u in one corner of a triangle.
  double u(std::size_t triangle, std::size_t corner) const;
  /// u on one side of interface `c`, edge `e`, at its begin (0) or end (1).
  double u_side(std::size_t c, std::size_t e, std::size_t end, bool plus) const;
  /// mu from the force on the minus side; none where the node has more than two sides, is a tip
  /// with one, lies on the Dirichlet boundary, or where the minus side is held by an inclusion.
  std::optional<double> multiplier(std::size_t c, std::size_t e, std::size_t end) const;
  double displacement(std::size_t inclusion) const;  ///< in its middle
  std::array<double, 2> slope(std::size_t inclusion) const;
  double energy() const noexcept { return _energy; }
  /// Conditions that hold with equality, and those that do not.
  int closed() const noexcept { return _closed; }
  int open() const noexcept { return _open; }

 private:
  struct Ends {  // corners (3 t + k) on both sides of an edge at one end
    std::int32_t plus = -1, minus = -1;
  };
  struct Edge {
    std::int32_t a, b;
    mesh::Kind kind;
    std::int32_t inclusion;
    double length;
    Ends end[2];
  };
  struct Inequality {  // u[upper] - u[lower] >= 0
    std::int32_t upper, lower;
  };

  void find_edges();
  void double_nodes();
  void find_bodies();
  std::array<double, 2> direction(std::int32_t body) const;
  void tie(const MonolithicLoad& load);
  void solve(const MonolithicLoad& load);
  Eigen::VectorXd project(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& gap);

  const mesh::Mesh& _mesh;
  std::vector<char> _dirichlet;
  std::vector<std::vector<Edge>> _edges;  // per interface
  std::vector<std::int32_t> _dof;         // of each corner
  std::int32_t _dofs = 0;
  std::vector<std::int32_t> _body;  // of each inclusion: the first of those it shares nodes with
  std::vector<std::array<double, 2>> _middle;  // of each inclusion's bounding box
  std::vector<char> _rigid;                    // dofs that are the plus side of an inclusion
  // Unknowns are the dofs, then A, Bx, By of each inclusion: _particular + _free z.
  Eigen::VectorXd _particular;
  Eigen::MatrixXd _free;
  std::vector<Inequality> _inequalities;
  Eigen::VectorXd _u;         // per dof
  Eigen::VectorXd _x;         // per unknown
  Eigen::VectorXd _residual;  // per dof: K u - f
  double _energy = 0;
  bool _solvable = true, _held = false, _converged = false;
  int _closed = 0, _open = 0;
};

}  // namespace anticrack::reference
