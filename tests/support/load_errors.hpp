// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "expression/function.hpp"
#include "fem/adaptive_load.hpp"
#include "support/exact_loads.hpp"

namespace anticrack::testing {

struct LoadErrors {
  double whole = 0;  ///< of the sum of the load
  double nodal = 0;  ///< the worst of a node, over the area that belongs to it
  fem::IntegrationReport report;
};

/// A number as expressions are written, to the last bit.
inline std::string text(double value) {
  std::ostringstream result;
  result.precision(17);
  result << (value < 0 ? "(" : "") << value << (value < 0 ? ")" : "");
  return result.str();
}

/// 1 on one side of a line, 0 on the other.
inline std::string beyond(const Line& line) {
  return "(" + text(line.a) + "*x + " + text(line.b) + "*y > " + text(line.c) + ")";
}

/// 1 in a disc, 0 outside.
inline std::string inside(PlanePoint centre, double radius) {
  return "((x - " + text(centre[0]) + ")^2 + (y - " + text(centre[1]) + ")^2 < " +
         text(radius * radius) + ")";
}

/// The function that a text says, for references.
inline Field field(const std::string& f) {
  return [function = std::make_shared<const expression::Function>(f, "f")](double x, double y) {
    return (*function)(x, y);
  };
}

/// Loads of the text f.
inline fem::IntegrationReport integrate(const PlaneMesh& mesh, const std::string& f,
                                        std::vector<double>& load,
                                        const fem::IntegrationLimits& limits = {}) {
  load.assign(mesh.node_count(), 7);
  return fem::integrate_load(mesh.xy, mesh.triangles, expression::Function(f, "f"), load, limits);
}

/// Integrates f over the mesh, compares with the exact load, prints what it cost.
inline LoadErrors compare(const std::string& name, const PlaneMesh& mesh, const std::string& f,
                          const std::vector<double>& exact,
                          const fem::IntegrationLimits& limits = {}) {
  LoadErrors errors;
  std::vector<double> load;
  errors.report = integrate(mesh, f, load, limits);
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
