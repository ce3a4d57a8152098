// SPDX-License-Identifier: GPL-3.0-or-later
//
// A sweep made up without a server, on the membrane of sample_result: the crack closes from the
// left as the coefficient falls.
#pragma once

#include <cstddef>
#include <cstdint>

#include "support/sample_result.hpp"

namespace anticrack::testing {

/// Loads skew and opening, skew with coefficient 1 and opening with one from -1 to 1; `rows` at
/// least 3, the last but one not converged, traces of the first and the last kept; 2n + 1 nodes.
inline results::Result sample_sweep(std::size_t rows = 21, int n = 10) {
  results::Result result = sample_result(n);
  const results::Interface& line = result.interfaces[0];
  results::Sweep sweep;
  sweep.loads = {"skew", "opening"};
  sweep.inclusions = {"fibre"};
  sweep.source = "ratio.csv";
  sweep.solve_seconds = 0.25;
  for (std::size_t i = 0; i < line.node_count(); ++i) {
    if (line.kind[i] == results::Kind::delaminated) {
      sweep.contact_nodes.insert(sweep.contact_nodes.end(), {0, static_cast<std::int32_t>(i)});
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double c = -1 + 2 * static_cast<double>(row) / static_cast<double>(rows - 1);
    sweep.coefficients.insert(sweep.coefficients.end(), {1, c});
    sweep.status.push_back(row + 2 == rows ? results::Status::not_converged
                                           : results::Status::converged);
    sweep.steps.push_back(static_cast<std::int32_t>(2 + row % 4));
    sweep.energy.push_back(-1 - c * c);
    sweep.kkt.push_back(1e-13);
    sweep.displacement.push_back(0.1 * c);
    double length = 0;
    for (std::size_t k = 0; k < sweep.contacts(); ++k) {
      const double x = line.x[static_cast<std::size_t>(sweep.contact_nodes[2 * k + 1])];
      const bool closed = x < -c / 2;
      sweep.contact.push_back(closed ? 1 : 0);
      length += closed ? 1.0 / n : 0.0;
    }
    sweep.contact_length.push_back(length);
  }
  sweep.kept = {0, static_cast<std::int32_t>(rows) - 1};
  for (std::size_t i = 0; i < result.loads.size(); ++i) {
    results::Load& load = result.loads[i];
    load.answer.set_name(results::row_name(sweep.kept[i]));
    load.history = {};
    load.fields.clear();
    load.asked.method = "active-set";
  }
  result.sweep = sweep;
  return result;
}

/// The same with bounds, of the energy 0.5 % wide and A +- 0.01; none of the last row.
inline results::Result bounded_sweep(std::size_t rows = 21, int n = 10) {
  results::Result result = sample_sweep(rows, n);
  results::Sweep& sweep = *result.sweep;
  sweep.energy_upper = sweep.energy;
  for (const double energy : sweep.energy) sweep.energy_lower.push_back(1.005 * energy);
  for (const double a : sweep.displacement) {
    sweep.displacement_lower.push_back(a - 0.01);
    sweep.displacement_upper.push_back(a + 0.01);
  }
  for (auto* bounds : {&sweep.energy_lower, &sweep.energy_upper, &sweep.displacement_lower,
                       &sweep.displacement_upper})
    bounds->back() = results::unknown;
  return result;
}

/// sample_sweep of an inclusion that tilts: Bx = 0.2 c and By = -0.5 for the coefficient c.
inline results::Result tilting_sweep(std::size_t rows = 21, int n = 10) {
  results::Result result = sample_sweep(rows, n);
  for (const double a : result.sweep->displacement) {
    result.sweep->slope.insert(result.sweep->slope.end(), {2 * a, -0.5});
  }
  return result;
}

}  // namespace anticrack::testing
