// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

#include "fem/adaptive_load.hpp"
#include "support/exact_loads.hpp"

namespace anticrack::testing {

struct LoadErrors {
  double whole = 0;  ///< of the sum of the load
  double nodal = 0;  ///< the worst of a node, over the area that belongs to it
  fem::IntegrationReport report;
};

/// Integrates f over the mesh, compares with the exact load, prints what it cost.
inline LoadErrors compare(const std::string& name, const PlaneMesh& mesh, const Field& f,
                          const std::vector<double>& exact,
                          const fem::IntegrationLimits& limits = {}) {
  LoadErrors errors;
  std::vector<double> load(mesh.node_count());
  errors.report = fem::integrate_load(mesh.xy, mesh.triangles, f, load, limits);
  const std::vector<double> areas = node_areas(mesh);
  for (std::size_t i = 0; i < load.size(); ++i) {
    errors.whole += load[i] - exact[i];
    errors.nodal = std::max(errors.nodal, std::abs(load[i] - exact[i]) / areas[i]);
  }
  errors.whole = std::abs(errors.whole);
  const auto count = static_cast<double>(mesh.triangle_count());
  std::cout << name << ": error " << errors.whole << ", nodal " << errors.nodal << ", estimate "
            << errors.report.relative_error_estimate << ", "
            << static_cast<double>(errors.report.evaluations) / count << " evaluations a triangle, "
            << errors.report.cut_triangles << " of " << mesh.triangle_count() << " cut\n";
  return errors;
}

}  // namespace anticrack::testing
