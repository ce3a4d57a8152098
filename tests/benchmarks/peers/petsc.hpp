// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the methods of bench_petsc have in common.
#pragma once

#include <petsc.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/peers/monolithic.hpp"

namespace anticrack::benchmarks {

struct PeerAnswer {
  double displacement = 0;  ///< A
  double energy = 0;
  int steps = 0;
};

/// One way to solve, on one mesh.
class Peer {
 public:
  virtual ~Peer() = default;
  /// A load case, on the nodes of the mesh.
  virtual PeerAnswer solve(const std::vector<double>& nodal_force) = 0;
};

/// The best a clever user gets: MUMPS factorises the interior and leaves the Schur complement on
/// contacts and A (MatFactorSetSchurIS); a dense active set on it. One solve with the interior a
/// load. `ordering`: ICNTL(7) of MUMPS.
std::unique_ptr<Peer> schur_peer(const PlainMesh& mesh, int ordering);

/// SNESVI, reduced space, each step's matrix factorised by CHOLMOD.
std::unique_ptr<Peer> snesvi_peer(const PlainMesh& mesh);

/// TAO TRON, its conjugate gradients preconditioned by a CHOLMOD factor of each step's matrix.
std::unique_ptr<Peer> tron_peer(const PlainMesh& mesh);

/// The symmetric matrix on PETSc's books; `system` must outlive it.
Mat symmetric_matrix(Monolithic& system);

/// Throws std::runtime_error where a call of PETSc failed.
inline void require(PetscErrorCode code, const char* what) {
  if (code != 0) throw std::runtime_error(std::string("PETSc failed: ") + what);
}

}  // namespace anticrack::benchmarks
