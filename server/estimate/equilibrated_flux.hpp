// SPDX-License-Identifier: GPL-3.0-or-later
//
// A flux in equilibrium with the load, near the flux of a discrete solution: RT0, made fan by fan
// without a linear solve. Braess & Schoeberl, Math. Comp. 77 (2008), for contact and inclusions.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

/// What a flux is made for. Of triangles and Neumann edges subdomain after subdomain, as in
/// CutMesh; empty: 0.
struct Balance {
  std::span<const double> u;         ///< (copies) the discrete solution
  std::span<const double> force;     ///< (corners) int_T f phi_i
  std::span<const double> traction;  ///< (Neumann edges, 2) int g phi_i at ends 0 and 1
};

/// Bounds of the fluxes through minus faces, (faces, 2) at ends 0 and 1, of any sign: |w| <= bound.
/// Empty: w <= 0 instead, the contact pressure.
using FaceBounds = std::span<const double>;

/// sigma with  div sigma + f = 0  in the elementwise linear f of `force`, sigma.n = mean g on
/// Neumann edges, continuous across all edges but cracks' and inclusions'; on a minus face
/// sigma.n = -p, on both of a crack the same; through the faces of an inclusion the force on it.
/// RT0 gives those of one that tilts another moment than the nodal forces have; there kappa
/// curl(l_0 l_1) is added, which changes no other flux and no mean. O(m); `polish`: sweeps over the
/// fans, after the first, that bring it nearer to T grad u. All vectors are those after the maps of
/// the tension, and T is its mean on each triangle (Shapes).
class EquilibratedFlux {
 public:
  EquilibratedFlux(const CutMesh& cut, const Balance& balance, FaceBounds bounds = {},
                   int polish = 1);
  /// Of several loads at once, with the bits of each alone: all with a force or none. No bounds:
  /// the pressure, else those of each.
  static std::vector<EquilibratedFlux> of_all(const CutMesh& cut, std::span<const Balance> loads,
                                              std::span<const FaceBounds> bounds = {},
                                              int polish = 1);

  /// int |sigma - T grad u|^2 / T of each triangle, shape (m).
  const std::vector<double>& distance() const noexcept { return _distance; }
  /// int p [u] of each face, on minus faces, shape (faces): 0 elsewhere.
  std::vector<double> work_of_pressure() const;
  /// Outward flux through each face, (faces, 2): the parts of its ends 0 and 1.
  const std::vector<double>& through_faces() const noexcept { return _through; }
  /// sigma - T grad u in a point of a triangle given by its barycentric coordinates.
  Vector difference(std::size_t triangle, const std::array<double, 3>& place) const;
  /// Its mean over a triangle; where `turned` is false and f is 0 it is constant.
  Vector mean_difference(std::size_t triangle) const;
  /// The same times sqrt(area / T): its square is its part of distance().
  const Vector& mean(std::size_t triangle) const { return _mean[triangle]; }
  bool turned(std::size_t triangle) const;
  /// [u] at an end of a minus face.
  double jump(std::size_t face, std::size_t end) const;
  /// Sum of v_i e_i of a triangle (Shapes); turned by 90 degrees, sqrt(area / T) grad v.
  Vector rise_of(std::size_t triangle, std::span<const double> values) const {
    const std::int32_t* copy = &_cut.copy[3 * triangle];
    const Vector* edge = &_edge[3 * triangle];
    const double first = values[at(copy[0])], second = values[at(copy[1])] - first,
                 third = values[at(copy[2])] - first;
    return {second * edge[1][0] + third * edge[2][0], second * edge[1][1] + third * edge[2][1]};
  }
  /// T grad v of a triangle, and its outward flux through a side; values of v in the copies.
  Vector flux_of(std::size_t triangle, std::span<const double> values) const;
  double flux_through(std::size_t side, std::span<const double> values) const;
  /// int grad v.T grad v of a triangle, the square of a norm.
  double energy_of(std::size_t triangle, std::span<const double> values) const {
    const Vector rise = rise_of(triangle, values);
    return _tension[triangle] * _tension[triangle] * dot(rise, rise);
  }
  double tension(std::size_t triangle) const { return _tension[triangle]; }
  double area(std::size_t triangle) const { return _area[triangle]; }
  /// Outward normal of a side, as long as the side.
  Vector normal_of(std::size_t side) const;
  /// int |T grad u|^2 / T.
  double norm_squared() const noexcept { return _norm_squared; }
  /// Sum of the imbalances of closed fans: rounding, where u solves the discrete problem.
  double imbalance() const noexcept { return _imbalance; }

 private:
  EquilibratedFlux(const Balance& balance, const CutMesh& cut);  // to be made
  static void make(std::span<EquilibratedFlux> fluxes, std::span<const FaceBounds> bounds,
                   int polish);
  void turn();

  const CutMesh& _cut;
  Balance _balance;
  const std::vector<double>&_tension, &_area;  // (m)
  const std::vector<Vector>& _edge;            // (corners) e_i
  std::vector<Vector> _mean;                   // (m)
  std::vector<double> _distance, _through;
  struct Turn {
    std::size_t side;
    double kappa;
  };
  std::vector<Turn> _turns;  // by triangle
  std::vector<Turn>::const_iterator first_turn(std::size_t triangle) const;
  double _norm_squared = 0;
  double _imbalance = 0;
};

}  // namespace anticrack::estimate
