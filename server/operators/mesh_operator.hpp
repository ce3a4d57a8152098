// SPDX-License-Identifier: GPL-3.0-or-later
//
// Everything that is kept of a mesh between load cases, behind plain types: the layers above see
// neither Eigen nor CHOLMOD.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "contact/answer.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::operators {

/// Factorised subdomains, Schur complements, the skeleton condensed to the cracks, interface mass
/// and theta* of one mesh.
/// Immutable after construction: any number of threads may solve on it at once.
class MeshOperator {
 public:
  /// Factorises every subdomain (paper: the matrices of Algorithm 2), two at a time where
  /// `threads` allows. Throws errors::Error: numerical (a part that nothing or
  /// contact alone holds), cancelled. Cost: one sparse Cholesky per subdomain plus O(n_G^3) on the
  /// interface nodes.
  static std::shared_ptr<const MeshOperator> factorise(std::shared_ptr<const mesh::Mesh> mesh,
                                                       int threads, std::stop_token stop);
  ~MeshOperator();

  /// One load case. O(n_G^2) an iteration of Algorithm 2, O(c^3) a step of the active set with c
  /// crack nodes, O(N) before and (for fields) after.
  /// Same mesh, load and options: same bits. Throws errors::Error (expression_invalid: a value that
  /// is not finite, with the place; invalid_argument: a subdomain or inclusion the mesh does not
  /// have, an array of another length, a point outside; not_implemented: Uzawa where
  /// ddm::uzawa_obstacle has a reason; cancelled: `stop` was requested while the load was
  /// integrated, before there is an iteration that the observer could stop).
  contact::Answer solve(const fem::Load& load, const contact::SolverOptions& options, bool fields,
                        contact::Observer& observer, const std::stop_token& stop = {}) const;

  const mesh::Mesh& mesh() const noexcept;
  /// Per interface of the mesh.
  const std::vector<contact::TraceGeometry>& trace_geometry() const noexcept;
  /// Triangles of a subdomain, (m_i,3) row-major, as indices into Field::nodes of its answers: with
  /// two sides of a slit in one subdomain a mesh node is there twice, once a side.
  const std::vector<std::int32_t>& field_triangles(std::size_t subdomain) const;
  /// Memory held, measured, bytes (the mesh included).
  std::size_t bytes() const noexcept;
  /// theta* for lumped mass; 0 where Algorithm 2 does not apply.
  double theta_star() const noexcept;

 private:
  struct Parts;
  explicit MeshOperator(std::unique_ptr<const Parts> parts);
  std::unique_ptr<const Parts> _parts;
};

/// Upper estimate of bytes() before factorising. O(m).
std::size_t estimate_bytes(const mesh::Mesh& mesh);

/// Throws errors::Error (internal) unless BLAS is the pthread build of OpenBLAS, and sets it to one
/// thread: the serial build gave 40 wrong factors of 44 under threads, silently.
void require_threadsafe_blas();

}  // namespace anticrack::operators
