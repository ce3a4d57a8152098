// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "contact/contact_problem.hpp"
#include "estimate/lack.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

/// A displacement of an inclusion, A or a slope, the unit force that works on it, and where its
/// bounds go.
struct Aim {
  const ddm::Terms& goal;
  std::size_t inclusion;
  fem::Moment moment;  ///< of a slope
  double contact::InclusionAnswer::*value;
  std::optional<double> contact::InclusionAnswer::*lower, contact::InclusionAnswer::*upper;
  std::optional<double> contact::InclusionAnswer::*estimate = nullptr;

  fem::Load force(const mesh::Mesh& mesh) const;
  /// The same, of each of so many inclusions.
  std::vector<estimate::ForceOn> unit(std::size_t inclusions) const;
  double value_in(const contact::Answer& answer) const {
    return answer.inclusions[inclusion].*value;
  }
  void set(contact::Answer& answer, double low, double high) const {
    answer.inclusions[inclusion].*lower = low;
    answer.inclusions[inclusion].*upper = high;
  }
};

/// Of all inclusions: A, then the slopes where one tilts. Refer to the decomposition.
std::vector<Aim> aims(const MeshOperator::Parts& parts);

/// As contact::ContactProblem::unit_force.
std::vector<contact::UnitForce> unit_forces(const MeshOperator::Parts& parts,
                                            std::span<const Aim> goals);

/// |tau| of each goal's unit force, tau in equilibrium with it and nothing through contacts;
/// infinite where contact alone holds a part, 0 of a held inclusion. Made once for the mesh: a
/// linear solve, a field and a flux each; of many on a joined membrane after a factor.
const std::vector<double>& flux_norms(const MeshOperator::Parts& parts,
                                      const estimate::CutMesh& cut, std::span<const Aim> goals);

}  // namespace anticrack::operators
