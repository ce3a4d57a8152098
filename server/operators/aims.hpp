// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "contact/answer.hpp"
#include "contact/contact_problem.hpp"
#include "estimate/lack.hpp"
#include "estimate/mesh_dual.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// A displacement of an inclusion, A or a slope, with the unit force that does work on it and the
/// members of the answer that have its value on the mesh and take its bounds.
struct Aim {
  const ddm::Terms& goal;
  std::size_t inclusion;
  fem::Moment moment;  ///< the unit moment, for a slope
  double contact::InclusionAnswer::*value;
  std::optional<double> contact::InclusionAnswer::*lower, contact::InclusionAnswer::*upper;
  std::optional<double> contact::InclusionAnswer::*estimate = nullptr;
  std::optional<double> contact::InclusionAnswer::*scale = nullptr;
  std::optional<double> known = {};  ///< the value on the mesh, if it is no inclusion's

  fem::Load force(const mesh::Mesh& mesh) const;
  /// The unit force as forces on all inclusions, of which there are `inclusions`.
  std::vector<estimate::ForceOn> unit(std::size_t inclusions) const;
  double value_in(const contact::Answer& answer) const {
    return known ? *known : answer.inclusions[inclusion].*value;
  }
  void set(contact::Answer& answer, double low, double high) const {
    answer.inclusions[inclusion].*lower = low;
    answer.inclusions[inclusion].*upper = high;
  }
  /// Sets the size to which a displacement of 0 compares: the root of `compliance`, the
  /// displacement under the unit force, times |u|.
  void set_scale(contact::Answer& answer, double compliance, double norm) const {
    if (scale != nullptr)
      answer.inclusions[inclusion].*scale = std::sqrt(std::max(0.0, compliance)) * norm;
  }
};

/// The aims of all inclusions: A, then the slopes if it tilts. They refer to the decomposition.
std::vector<Aim> aims(const MeshOperator::Parts& parts);

/// contact::ContactProblem::unit_force for each goal.
std::vector<contact::UnitForce> unit_forces(const MeshOperator::Parts& parts,
                                            std::span<const Aim> goals);

/// The pair of each goal, of which none is known if contact alone holds a part. Made once for the
/// mesh, on base::Threads, at the cost of a linear solve, half of another, a field and a flux each;
/// many goals on a joined membrane take a factorisation first.
const std::vector<estimate::MeshDual>& mesh_duals(const MeshOperator::Parts& parts,
                                                  const estimate::CutMesh& cut,
                                                  std::span<const Aim> goals);

}  // namespace anticrack::operators
