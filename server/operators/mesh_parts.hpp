// SPDX-License-Identifier: GPL-3.0-or-later
//
// The data of the types of mesh_operator.hpp; only this folder includes it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/lazy.hpp"
#include "contact/contact_problem.hpp"
#include "contact/solve.hpp"
#include "contact/sweep_solver.hpp"
#include "contact/trace_problem.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/neumann_boundary.hpp"
#include "ddm/subdomain_operator.hpp"
#include "estimate/cut_mesh.hpp"
#include "estimate/mesh_dual.hpp"
#include "estimate/stiff_part.hpp"
#include "operators/basis_cache.hpp"
#include "operators/boundary_forces.hpp"
#include "operators/condense_loads.hpp"
#include "operators/mesh_operator.hpp"
#include "tips/tips.hpp"

namespace anticrack::operators {

struct MeshOperator::Parts {
  Parts(std::shared_ptr<const mesh::Mesh> cut_mesh, int threads, std::size_t condensed_up_to);

  std::shared_ptr<const mesh::Mesh> mesh;
  ddm::Decomposition decomposition;
  ddm::NeumannBoundary neumann;                   // refers to the mesh and the decomposition
  std::vector<ddm::SubdomainOperator> operators;  // empty if the membrane is joined
  std::string uzawa_obstacle;
  contact::TraceProblem problem;  // refers to the decomposition and the operators
  std::unique_ptr<const contact::ContactProblem> contact;  // refers to the problem
  contact::SweepGeometry sweep_geometry;
  std::vector<contact::TraceGeometry> geometry;
  mutable std::atomic<std::size_t> at_work{0};  // bytes of Working; outlives what is counted in it
  mutable BasisCache bases;
  base::Lazy<estimate::CutMesh> cut;  // made for the first bounds; see cut_mesh()
  base::Lazy<std::vector<estimate::MeshDual>> mesh_duals;  // see aims.hpp
  base::Lazy<std::optional<estimate::StiffPart>> stiff;    // see stiff_part()
  base::Lazy<tips::Tips> tips;          // refers to the decomposition; see all_tips()
  base::Lazy<BoundaryForces> boundary;  // refers to the decomposition

  const estimate::CutMesh& cut_mesh() const;
  /// estimate::stiff_part, found at the first call; null if there is none.
  const estimate::StiffPart* stiff_part() const;
  /// The tips, prepared at the first call.
  const tips::Tips& all_tips() const;
  /// The parts of the boundary, found at the first call.
  const BoundaryForces& boundary_forces() const;
  /// The function that condenses the loads of a subdomain.
  Condense condense() const;
};

/// Per subdomain (m,3): int f hat_i for the corners i of each triangle; with `tips` only of those
/// near tips, the others are not set. Refers to the load.
struct ForceOnTriangles {
  ForceOnTriangles(const LoadParts& parts, const std::vector<ddm::Subdomain>& subdomains,
                   const tips::Tips* tips = nullptr);
  std::vector<std::unique_ptr<double[]>> linear;  ///< what `of_subdomains` refers to besides
  std::vector<std::span<const double>> of_subdomains;
};

struct PreparedLoad::Data {
  std::shared_ptr<const MeshOperator> mesh_operator;
  LoadOnTraces condensed;
  bool has_interior = true;  ///< false: a combination without bounds, which has no fields
  std::optional<BalancedLoad> balanced{};  ///< of a combination with bounds, instead of parts
  double parts_energy = 0;  ///< for a combination: sum |c_j c_k| |Pi_jk|, contacts closed

  contact::CaseLoads loads() const { return {condensed.subdomains, condensed.inclusion_forces}; }
  /// Adds the warnings of the load, which every answer to it repeats.
  void add_warnings(contact::Answer& answer) const;
};

struct LoadBasis::Data {
  std::shared_ptr<const MeshOperator> mesh_operator;
  std::shared_ptr<const CondensedBasis> basis;
};

}  // namespace anticrack::operators
