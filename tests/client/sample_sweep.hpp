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

/// The same paths, shapes and bits.
inline bool same(const results::Arrays& a, const results::Arrays& b) {
  return std::ranges::equal(a, b, [](const auto& one, const auto& other) {
    const results::Array &x = one.second, &y = other.second;
    const auto size = results::count_of(x.shape) * results::bytes_of(x.type);
    return one.first == other.first && x.type == y.type && x.shape == y.shape &&
           std::equal(x.data.get(), x.data.get() + size, y.data.get());
  });
}

inline bool same(const results::Sweep& a, const results::Sweep& b) {
  bool equal = a.answer.SerializeAsString() == b.answer.SerializeAsString();
  arrays::for_each(
      [&](const auto& row) { equal &= std::invoke(row.member, a) == std::invoke(row.member, b); },
      results::tables::sweep);
  return equal && same(a.columns, b.columns);
}

/// What the server says of the rows as a whole.
inline void count_rows(results::Sweep& sweep) {
  const auto count = [&sweep](v1::LoadCaseAnswer::Status status) {
    return static_cast<std::uint64_t>(std::ranges::count(sweep.status(), status));
  };
  sweep.answer.set_rows(sweep.rows());
  sweep.answer.set_converged(count(v1::LoadCaseAnswer::STATUS_CONVERGED));
  sweep.answer.set_not_converged(count(v1::LoadCaseAnswer::STATUS_NOT_CONVERGED));
  sweep.answer.set_failed(count(v1::LoadCaseAnswer::STATUS_FAILED));
  sweep.answer.set_most_steps(*std::ranges::max_element(sweep.integers("steps")));
  sweep.answer.set_worst_kkt(*std::ranges::max_element(sweep.numbers("kkt")));
}

/// Loads skew and opening, skew with coefficient 1 and opening with one from -1 to 1; `rows` at
/// least 3, the last but one not converged, traces of the first and the last kept; 2n + 1 nodes.
inline results::Result sample_sweep(std::size_t rows = 21, int n = 10) {
  results::Result result = sample_result(n);
  const Columns line = sample_interface(n);
  results::Sweep sweep;
  sweep.loads = {"skew", "opening"};
  sweep.inclusions = {"fibre"};
  sweep.source = "ratio.csv";
  results::tables::SweepColumns made;
  for (std::size_t i = 0; i < line.s.size(); ++i) {
    if (line.kind[i] == v1::INTERFACE_KIND_DELAMINATED) {
      made.contact_nodes.insert(made.contact_nodes.end(), {0, static_cast<std::int32_t>(i)});
    }
  }
  const std::size_t contacts = made.contact_nodes.size() / 2;
  for (std::size_t row = 0; row < rows; ++row) {
    const double c = -1 + 2 * static_cast<double>(row) / static_cast<double>(rows - 1);
    made.coefficients.insert(made.coefficients.end(), {1, c});
    made.status.push_back(row + 2 == rows ? v1::LoadCaseAnswer::STATUS_NOT_CONVERGED
                                          : v1::LoadCaseAnswer::STATUS_CONVERGED);
    made.steps.push_back(static_cast<std::int32_t>(2 + row % 4));
    made.energy.push_back(-1 - c * c);
    made.displacement.push_back(0.1 * c);
    double length = 0;
    for (std::size_t k = 0; k < contacts; ++k) {
      const double x = line.x[static_cast<std::size_t>(made.contact_nodes[2 * k + 1])];
      const bool closed = x < -c / 2;
      made.contact.push_back(closed ? 1 : 0);
      length += closed ? 1.0 / n : 0.0;
    }
    made.contact_length.push_back(length);
  }
  made.kept = {0, static_cast<std::int32_t>(rows) - 1};
  sweep.columns = {{"status", array_of(made.status)},
                   {"steps", array_of(made.steps)},
                   {"energy", array_of(made.energy)},
                   {"kkt", array_of(std::vector<double>(rows, 1e-13))},
                   {"contact_length", array_of(made.contact_length)},
                   {"displacement", array_of(made.displacement, {1})},
                   {"contact", array_of(made.contact, {contacts})},
                   {"contact_nodes", array_of(made.contact_nodes, {2})},
                   {"kept", array_of(made.kept)},
                   {"coefficients", array_of(made.coefficients, {2})}};
  results::Arrays arrays;
  for (auto& [path, array] : result.arrays) {
    if (path.starts_with("fields/") || path.find("/history/") != path.npos ||
        path.find("/fields/") != path.npos)
      continue;
    const bool first = path.starts_with("loads/opening/"),
               second = path.starts_with("loads/partly");
    arrays[!first && !second ? path
                             : results::load_path(results::row_name(made.kept[first ? 0 : 1])) +
                                   path.substr(path.find('/', 6) + 1)] = array;
  }
  result.arrays = std::move(arrays);
  for (std::size_t i = 0; i < result.loads.size(); ++i)
    result.loads[i].answer.set_name(results::row_name(made.kept[i]));
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
  results::Arrays& columns = result.sweep->columns;
  results::tables::SweepColumns made;
  for (const double energy : result.sweep->numbers("energy")) {
    made.energy_mesh.push_back(energy);
    made.energy_lower.push_back(1.005 * energy);
  }
  made.energy_upper = made.energy_mesh;
  for (const double a : result.sweep->numbers("displacement")) {
    made.displacement_lower.push_back(a - 0.01);
    made.displacement_upper.push_back(a + 0.01);
    made.displacement_mesh.push_back(a - 0.001);
  }
  for (auto* bounds :
       {&made.energy_lower, &made.energy_upper, &made.displacement_lower, &made.displacement_upper})
    bounds->back() = results::unknown;
  columns["energy_lower"] = array_of(made.energy_lower);
  columns["energy_upper"] = array_of(made.energy_upper);
  columns["energy_mesh"] = array_of(made.energy_mesh);
  columns["displacement_lower"] = array_of(made.displacement_lower, {1});
  columns["displacement_upper"] = array_of(made.displacement_upper, {1});
  columns["displacement_mesh"] = array_of(made.displacement_mesh, {1});
  return result;
}

/// sample_sweep of an inclusion that tilts: Bx = 0.2 c and By = -0.5 for the coefficient c.
inline results::Result tilting_sweep(std::size_t rows = 21, int n = 10) {
  results::Result result = sample_sweep(rows, n);
  std::vector<double> slope;
  for (const double a : result.sweep->numbers("displacement"))
    slope.insert(slope.end(), {2 * a, -0.5});
  result.sweep->columns["slope"] = array_of(slope, {1, 2});
  return result;
}

}  // namespace anticrack::testing
