// SPDX-License-Identifier: GPL-3.0-or-later
//
// A small factorised mesh and loads of a sweep on it.
#pragma once

#include <memory>
#include <stop_token>
#include <vector>

#include "contact/sweep_columns.hpp"
#include "operators/mesh_operator.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {

using anticrack::testing::Silent;
using Operator = std::shared_ptr<const MeshOperator>;

inline Operator factorised() {
  return MeshOperator::factorise(
      std::make_shared<const mesh::Mesh>(testing::structured_mesh({32, 8, {}, {}, {"bar"}})), 1,
      {});
}

inline std::vector<fem::Load> three_loads() {
  std::vector<fem::Load> loads(3);
  loads[0].force = 1.0;
  loads[1].force = fem::PerRegion{{{"upper", 1.0}, {"lower", -2.0}}};
  loads[1].boundary_value = "x*y";
  loads[2].force = fem::Expression{"x - 0.3*y"};
  loads[2].inclusion_forces["bar"] = 0.4;
  return loads;
}

inline std::shared_ptr<const LoadBasis> basis_of(const MeshOperator& op,
                                                 const std::vector<fem::Load>& loads,
                                                 const std::stop_token& stop = {}) {
  std::vector<const fem::Load*> pointers;
  for (const fem::Load& load : loads) {
    pointers.push_back(&load);
  }
  return op.basis(pointers, stop);
}

inline contact::SweepColumns columns(const MeshOperator& op, std::size_t rows) {
  return {rows, op.mesh().inclusions.size(), op.contact_nodes().size(), contact::tilts(op.mesh())};
}

}  // namespace anticrack::operators
