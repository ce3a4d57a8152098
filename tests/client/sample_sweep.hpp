// SPDX-License-Identifier: GPL-3.0-or-later
//
// A sweep made up without a server, on the membrane of sample_result: the crack closes from the
// left as the coefficient falls.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "results/tables.hpp"
#include "support/sample_result.hpp"

namespace anticrack::testing {

/// NaN is no NaN.
inline bool same(const results::Sweep& a, const results::Sweep& b) {
  bool equal = a.answer.SerializeAsString() == b.answer.SerializeAsString();
  arrays::for_each(
      [&](const auto& row) { equal &= std::invoke(row.member, a) == std::invoke(row.member, b); },
      results::tables::sweep, results::tables::sweep_arrays);
  return equal;
}

/// What the server says of the rows as a whole.
inline void count_rows(results::Sweep& sweep) {
  const auto count = [&sweep](v1::LoadCaseAnswer::Status status) {
    return static_cast<std::uint64_t>(std::ranges::count(sweep.status, status));
  };
  sweep.answer.set_rows(sweep.rows());
  sweep.answer.set_converged(count(v1::LoadCaseAnswer::STATUS_CONVERGED));
  sweep.answer.set_not_converged(count(v1::LoadCaseAnswer::STATUS_NOT_CONVERGED));
  sweep.answer.set_failed(count(v1::LoadCaseAnswer::STATUS_FAILED));
  sweep.answer.set_most_steps(*std::ranges::max_element(sweep.steps));
  sweep.answer.set_worst_kkt(*std::ranges::max_element(sweep.kkt));
}

/// Loads skew and opening, skew with coefficient 1 and opening with one from -1 to 1; `rows` at
/// least 3, the last but one not converged, traces of the first and the last kept; 2n + 1 nodes.
inline results::Result sample_sweep(std::size_t rows = 21, int n = 10) {
  results::Result result = sample_result(n);
  const results::Interface& line = result.interfaces[0];
  results::Sweep sweep;
  sweep.loads = {"skew", "opening"};
  sweep.inclusions = {"fibre"};
  sweep.source = "ratio.csv";
  for (std::size_t i = 0; i < line.node_count(); ++i) {
    if (line.kind[i] == v1::INTERFACE_KIND_DELAMINATED) {
      sweep.contact_nodes.insert(sweep.contact_nodes.end(), {0, static_cast<std::int32_t>(i)});
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double c = -1 + 2 * static_cast<double>(row) / static_cast<double>(rows - 1);
    sweep.coefficients.insert(sweep.coefficients.end(), {1, c});
    sweep.status.push_back(row + 2 == rows ? v1::LoadCaseAnswer::STATUS_NOT_CONVERGED
                                           : v1::LoadCaseAnswer::STATUS_CONVERGED);
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
  }
  result.solver.mutable_active_set();
  result.sweep = sweep;
  count_rows(*result.sweep);
  result.sweep->answer.mutable_solve_time()->set_nanos(250'000'000);
  return result;
}

/// The same with bounds, of the energy 0.5 % wide and A +- 0.01; none of the last row. On the mesh
/// A is 0.001 less.
inline results::Result bounded_sweep(std::size_t rows = 21, int n = 10) {
  results::Result result = sample_sweep(rows, n);
  results::Sweep& sweep = *result.sweep;
  sweep.energy_upper = sweep.energy_mesh = sweep.energy;
  for (const double energy : sweep.energy) sweep.energy_lower.push_back(1.005 * energy);
  for (const double a : sweep.displacement) {
    sweep.displacement_lower.push_back(a - 0.01);
    sweep.displacement_upper.push_back(a + 0.01);
    sweep.displacement_mesh.push_back(a - 0.001);
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
