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
/// fans, after the first, that bring it nearer to T grad u.
class EquilibratedFlux {
 public:
  EquilibratedFlux(const CutMesh& cut, const Balance& balance, FaceBounds bounds = {},
                   int polish = 1);

  /// int |sigma - T grad u|^2 / T of each triangle, shape (m).
  std::vector<double> distance() const;
  /// int p [u] of each face, on minus faces, shape (faces): 0 elsewhere.
  std::vector<double> work_of_pressure() const;
  /// Outward flux through each face, (faces, 2): the parts of its ends 0 and 1.
  const std::vector<double>& through_faces() const noexcept { return _through; }
  /// sigma - T grad u in a point of a triangle given by its barycentric coordinates.
  Vector difference(std::size_t triangle, const std::array<double, 3>& place) const;
  /// Its mean over a triangle; where `turned` is false and f is 0 it is constant.
  Vector mean_difference(std::size_t triangle) const;
  bool turned(std::size_t triangle) const;
  /// [u] at an end of a minus face.
  double jump(std::size_t face, std::size_t end) const;
  /// T grad v of a triangle, and its outward flux through a side; values of v in the copies.
  Vector flux_of(std::size_t triangle, std::span<const double> values) const;
  double flux_through(std::size_t side, std::span<const double> values) const;
  double tension(std::size_t triangle) const { return _tension[triangle]; }
  double area(std::size_t triangle) const { return _area[triangle]; }
  /// Outward normal of a side, as long as the side.
  Vector normal_of(std::size_t side) const;
  /// int |T grad u|^2 / T.
  double norm_squared() const noexcept { return _norm_squared; }
  /// Largest imbalance of a closed fan: rounding, where u solves the discrete problem.
  double imbalance() const noexcept { return _imbalance; }

 private:
  std::vector<double> measure();
  void balance(std::size_t triangle);
  void build(const std::vector<double>& half, FaceBounds bounds);
  void polish(FaceBounds bounds);
  void rotate(const FanCorner& corner, double flux);
  void turn();
  double slope_of_work(std::size_t fan) const;
  double step(std::size_t fan, double slope, FaceBounds bounds);
  double allowed(std::size_t fan, double best, FaceBounds bounds) const;
  std::span<const Stop> stops(std::size_t fan) const;
  std::span<const FanCorner> corners(std::size_t fan) const;

  const CutMesh& _cut;
  Balance _balance;
  bool _is_pressure;                           // the work of the pressure counts
  const std::vector<double>&_tension, &_area;  // (m)
  const std::vector<Vector>& _edge;            // (corners) opposite to the corner, counterclockwise
  std::vector<Vector> _mean;                   // (m) of sigma - T grad u, times 2 area
  std::vector<double> _rest;  // (m) int |sigma - T grad u - its mean|^2 times 4 area; empty: 0
  std::vector<double> _through;
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
