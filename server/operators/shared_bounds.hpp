// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the bounds of all rows of a sweep share. Everything of a row lies in the span of
//
//   u_b:  the response to each load of the sweep, every contact closed; to a unit jump of each
//         contact; and to a unit force on the A of each inclusion, every contact closed,
//
// with fluxes sigma_b that are linear, too, because each has the pressure that FacePressures
// divides: so the pressure of a row is >= 0 where its lambda is, whatever its contact. A row then
// turns it as far as p >= 0 allows. What bounds are made of are products of all these (THEORY.md,
// "Rows of a sweep").
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contact/sweep_solver.hpp"
#include "operators/aims.hpp"
#include "operators/face_pressures.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// Index b: the loads, the contacts, the goals, in this order. Index e: without the goals. Index k:
/// the turns.
struct SharedBounds {
  Eigen::Index loads = 0, contacts = 0, goals = 0;

  Eigen::MatrixXd flux;      ///< (b, b) int (sigma_b - T grad u_b).(sigma_c - T grad u_c) / T
  Eigen::MatrixXd turning;   ///< (k, b) int phi_k.(sigma_b - T grad u_b) / T
  Eigen::MatrixXd strain;    ///< (b, b) int T grad u_b.grad u_c; of contacts: S^
  Eigen::MatrixXd softness;  ///< (contacts, contacts) inverse of S^
  double inexact = 0;        ///< largest sum of a column of |S^ softness - 1|
  Eigen::MatrixXd traction;  ///< (contacts + goals, loads) l(u_b) - a(u_j, u_b) for the mean of g
  Eigen::MatrixXd oscillation;  ///< (loads, loads) sum of o_j o_k
  /// The same as `flux`, `strain` and FacePressures::overlap with the weight omega, the sum of o_j
  /// / |o_j| over the loads, and the sum of o_j o_k / omega; empty where all loads are balanced.
  struct Unbalanced {
    Eigen::MatrixXd flux, strain, oscillation;
    Eigen::SparseMatrix<double> overlap;
  } unbalanced;
  /// (loads, goals) int (f - f_h) z + int (g - g_h) z <= steep |z|_omega + moments max |z|.
  Eigen::MatrixXd steep, moments;
  Eigen::VectorXd norm;        ///< (b) roots of the diagonal of `flux`
  Eigen::VectorXd largest;     ///< (b) max |u_b|
  Eigen::VectorXd lack, work;  ///< (b) estimate::Lack
  double beyond = 0;           ///< Lack::flux for each unit of lambda that is not admissible
  double largest_tension = 0;
  std::vector<contact::UnitForce> unit;  ///< (goals)
  std::vector<std::size_t> inclusion;    ///< (goals)

  FacePressures pressures;

  auto stiffness() const { return strain.block(loads, loads, contacts, contacts); }  ///< S^
  std::size_t bytes() const noexcept;
};

/// Whether rows of a sweep of `loads` loads share bounds: where they are bounded by adjoints,
/// nothing varies inside triangles, and so many rows pay for the products. Depends on the mesh and
/// the numbers alone.
bool shares_bounds(const MeshOperator::Parts& parts, std::size_t loads, std::uint64_t rows);

/// The products, for loads that balance `balanced`; null if g_D of one is not linear along edges,
/// or if the flux of one is not in equilibrium, as where cracks cross. O(m b^2).
std::shared_ptr<const SharedBounds> shared_bounds(const MeshOperator::Parts& parts,
                                                  std::span<const LoadOnTraces> loads,
                                                  std::span<const BalancedLoad> balanced,
                                                  const contact::SweepLoads& reduced);

}  // namespace anticrack::operators
