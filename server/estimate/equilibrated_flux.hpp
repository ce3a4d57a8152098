// SPDX-License-Identifier: GPL-3.0-or-later
//
// A flux in equilibrium with the load, near the flux of a discrete solution: an RT0 field, made fan
// by fan without a linear solve, after Braess & Schoeberl, Math. Comp. 77 (2008), extended to
// contact and inclusions.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/large.hpp"
#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

struct FluxBlock;

/// The data from which a flux is made. Triangles and Neumann edges are in the order of CutMesh; an
/// empty member means 0.
struct Balance {
  std::span<const double> u;         ///< (copies) the discrete solution
  std::span<const double> force;     ///< (corners) int_T f phi_i
  std::span<const double> traction;  ///< (Neumann edges, 2) int g phi_i at ends 0 and 1
};

/// Bounds of the fluxes through minus faces, (faces, 2) at ends 0 and 1: least <= w <= most. Empty:
/// w <= 0, as for contact pressure.
struct FaceBounds {
  std::span<const double> least{}, most{};
};

/// sigma with  div sigma + f = 0  for the elementwise linear f of `force`, and sigma.n = mean g on
/// Neumann edges. Its normal component is continuous across all edges except those of cracks and
/// inclusions; on minus faces sigma.n = -p, the same on both faces of a crack; the flux through the
/// faces of an inclusion is the force on it. On the faces of an inclusion that tilts, RT0 has
/// another moment than the nodal forces; there kappa curl(l_0 l_1) is added, which changes no other
/// flux and no mean. O(m), on base::Threads; no bit depends on their number. `polish`: further
/// sweeps over the fans, which bring sigma nearer to T grad u. Vectors are those after the maps of
/// the tension; T is the mean on each triangle (Shapes).
class EquilibratedFlux {
 public:
  EquilibratedFlux(const CutMesh& cut, const Balance& balance, FaceBounds bounds = {},
                   int polish = 1);
  /// Makes the fluxes of several loads at once; the bits of each are as if it were alone. Either
  /// all loads have a force or none has. `bounds`: those of each load, or empty: w <= 0.
  /// `distances`: whether distance() is wanted.
  static std::vector<EquilibratedFlux> of_all(const CutMesh& cut, std::span<const Balance> loads,
                                              std::span<const FaceBounds> bounds = {},
                                              int polish = 1, bool distances = true);

  /// int |sigma - T grad u|^2 / T over each triangle, shape (m); empty if it is not wanted.
  const base::Large<double>& distance() const noexcept { return _distance; }
  /// int p [u] over each minus face, 0 for other faces; shape (faces).
  std::vector<double> work_of_pressure() const;
  /// Outward flux through each face, (faces, 2): the parts that belong to its ends 0 and 1.
  const std::vector<double>& through_faces() const noexcept { return _through; }
  /// sigma - T grad u in a point of a triangle given by its barycentric coordinates.
  Vector difference(std::size_t triangle, const std::array<double, 3>& place) const;
  /// The mean of that difference over a triangle; it is constant if `turned` is false and f is 0.
  Vector mean_difference(std::size_t triangle) const;
  /// The same times sqrt(area / T); its square is a part of distance().
  Vector mean(std::size_t triangle) const {
    const double* of = _mean + 2 * _lanes * triangle;
    return {of[0], of[_lanes]};
  }
  bool turned(std::size_t triangle) const { return !_turns.empty() && has_turn(triangle); }
  /// [u] at an end of a minus face.
  double jump(std::size_t face, std::size_t end) const;
  /// Sum of v_i e_i of a triangle (Shapes), which is sqrt(area / T) grad v turned by 90 degrees.
  Vector rise_of(std::size_t triangle, std::span<const double> values) const {
    const std::int32_t* copy = &_cut.copy[3 * triangle];
    const Vector* edge = &_edge[3 * triangle];
    const double first = values[at(copy[0])], second = values[at(copy[1])] - first,
                 third = values[at(copy[2])] - first;
    return {second * edge[1][0] + third * edge[2][0], second * edge[1][1] + third * edge[2][1]};
  }
  /// T grad v on a triangle, and its outward flux through a side; `values`: v in the copies.
  Vector flux_of(std::size_t triangle, std::span<const double> values) const;
  double flux_through(std::size_t side, std::span<const double> values) const;
  /// int grad v.T grad v over a triangle.
  double energy_of(std::size_t triangle, std::span<const double> values) const {
    const Vector rise = rise_of(triangle, values);
    return _tension[triangle] * _tension[triangle] * dot(rise, rise);
  }
  double tension(std::size_t triangle) const { return _tension[triangle]; }
  double area(std::size_t triangle) const { return _area[triangle]; }
  /// Outward normal of a side, with the length of the side.
  Vector normal_of(std::size_t side) const;
  /// int |T grad u|^2 / T.
  double norm_squared() const noexcept { return _norm_squared; }
  /// Sum of the imbalances of closed fans; it is rounding error if u solves the discrete problem.
  double imbalance() const noexcept { return _imbalance; }

 private:
  EquilibratedFlux(const Balance& balance, const CutMesh& cut, bool distances);  // not made yet
  static void make(std::span<EquilibratedFlux> fluxes, std::span<const FaceBounds> bounds,
                   int polish);
  /// Takes its lane of what the blocks found and of the fluxes `through` faces.
  void finish(std::size_t lane, std::size_t lanes, std::span<const FluxBlock> blocks,
              std::span<const double> through);
  void turn();

  const CutMesh& _cut;
  Balance _balance;
  const std::vector<double>&_tension, &_area;         // (m)
  const base::Large<Vector>& _edge;                   // (corners) e_i
  std::shared_ptr<const base::Large<double>> _means;  // (m, 2, lanes) of all made together
  const double* _mean = nullptr;                      // its own first one
  std::size_t _lanes = 1;
  base::Large<double> _distance;
  std::vector<double> _through;
  struct Turn {
    std::size_t side;
    double kappa;
  };
  std::vector<Turn> _turns;  // sorted by triangle
  std::vector<Turn>::const_iterator first_turn(std::size_t triangle) const;
  bool has_turn(std::size_t triangle) const;
  double _norm_squared = 0;
  double _imbalance = 0;
};

/// The largest absolute value; 0 if there is none.
double largest_of(std::span<const double> values);

/// What two forces (Balance::force of a triangle) add to the product of their fluxes over T, beside
/// the means: their parts of the flux that have no mean.
double rest_of_forces(const CutMesh& cut, std::size_t triangle, const double* f, const double* g);

}  // namespace anticrack::estimate
