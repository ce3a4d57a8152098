// SPDX-License-Identifier: GPL-3.0-or-later
//
// How the forces of contacts press on the minus faces beside them. They are divided by lengths, so
// that the pressure is linear in them and >= 0 where they are. The flux phi_k that flows round the
// node of a fan, 1 through each spoke, then takes pressure from one face beside the node to the
// other; it has no divergence, and no body feels it.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/at.hpp"
#include "estimate/cut_mesh.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// Per face and end, (faces, 2), the condition of contact there, an index into
/// ddm::Skeleton::contacts; -1 off the minus faces, where [u] = 0, as at tips, and where interfaces
/// cross and [u] >= 0 follows from other conditions. O(faces log contacts).
std::vector<std::int32_t> contact_at_ends(const MeshOperator::Parts& parts,
                                          const estimate::CutMesh& cut);

/// Index e: ends 0 and 1 of one minus face after the other. Index k: the turns phi_k.
struct FacePressures {
  /// There [u] is the sum of d[i], i one of jumps[first], ..., jumps[last - 1], and the pressure
  /// takes part lambda[force] and what phi_k brings. More than one i only where interfaces cross.
  struct End {
    std::int32_t first = 0, last = 0, force = -1;
    double part = 0;
  };
  /// phi_k adds `sign` to the pressure at each end; -1: it has only one.
  struct Turn {
    std::size_t fan = 0;  ///< of CutMesh
    std::array<std::int32_t, 2> end{-1, -1};
    std::array<double, 2> sign{};
  };
  std::vector<std::int32_t> faces;      ///< the minus faces, of CutMesh
  std::vector<End> ends;                ///< (e)
  std::vector<std::int32_t> jumps;      ///< contacts, of the ends
  std::vector<Turn> turns;              ///< (k)
  Eigen::SparseMatrix<double> overlap;  ///< (k, k) int phi_k.phi_l / T

  /// A pressure, times length, at the ends, and the coefficients of phi_k in it.
  struct Turned {
    Eigen::VectorXd ends, by;
  };
  /// The pressure of forces on the contacts, not turned.
  Turned divided(const Eigen::VectorXd& forces) const;
  /// (faces of CutMesh, 2) the flux of a pressure out of its faces, as estimate::FaceBounds has it.
  std::vector<double> through(std::size_t all_faces, const Eigen::VectorXd& pressure) const;
  /// int p [u], u with the jumps d.
  double work(const Eigen::VectorXd& pressure, const Eigen::Ref<const Eigen::VectorXd>& d) const;
  /// Its derivatives by the turns, which are int phi_k.grad u as well.
  Eigen::VectorXd slopes_of_work(const Eigen::Ref<const Eigen::VectorXd>& d) const;
  /// Turns one phi_k after the other towards the least sum of slope.a + a'O a / 2, O the overlap,
  /// with the pressures between `least` and `most`, or no farther from them. O(turns).
  void turn(const Eigen::VectorXd& slope, const Eigen::VectorXd& least, const Eigen::VectorXd& most,
            Turned& turned) const;

  std::span<const std::int32_t> jumps_at(Eigen::Index end) const {
    return std::span(jumps).subspan(at(ends[at(end)].first),
                                    at(ends[at(end)].last - ends[at(end)].first));
  }
  /// Whether [u] = 0 at an end by closed contacts.
  bool closed_at(Eigen::Index end, const std::vector<char>& closed) const;
  std::size_t bytes() const noexcept;
};

/// All but the overlap. There is a turn for each fan at minus faces where the flux through its
/// other faces may change, no body feels it, and both ends have the force of one contact: what
/// obeys a cone then does so when turned, too.
FacePressures face_pressures(const MeshOperator::Parts& parts, const estimate::CutMesh& cut);

}  // namespace anticrack::operators
