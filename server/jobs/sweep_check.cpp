// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "errors/placed.hpp"
#include "store/array_upload.hpp"
#include "store/files.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using records::SweepSpec;

constexpr std::uint64_t combinations_a_case = 256;
constexpr std::uint64_t forces_a_case = (1U << 20U) / sizeof(double);
constexpr std::uint64_t bounded_cost = 32;  // cost of a row with bounds, in rows without

std::uint64_t parts(std::uint64_t whole, std::uint64_t part) {
  return std::max<std::uint64_t>(1, (whole + part - 1) / part);
}

bool combines(const SweepSpec& sweep) { return sweep.cases == SweepSpec::Cases::combinations; }

std::string trace_path(std::size_t index) { return fmt::format("sweep.traces[{}]", index); }

void check_loads(const SweepSpec& sweep, std::size_t loads, std::size_t max_basis) {
  if (!combines(sweep)) {
    if (loads != 0) {
      throw Error(Reason::invalid_argument,
                  "the sweep brings its own loads as nodal forces, so the {} load cases would not "
                  "be solved: leave them out, or give coefficients to combine them with",
                  loads)
          .at("load_cases");
    }
    return;
  }
  if (loads == 0) {
    throw Error(Reason::invalid_argument,
                "the sweep combines load cases and the job has none: give at least one, or nodal "
                "forces in place of coefficients")
        .at("load_cases");
  }
  if (loads > max_basis) {
    throw Error(
        Reason::limit_exceeded,
        "{} load cases: a sweep may combine {}, so combine fewer, or sweep over nodal forces",
        loads, max_basis)
        .at("load_cases");
  }
}

void check_traces(const SweepSpec& sweep, std::size_t max_traces) {
  const std::vector<std::uint32_t>& traces = sweep.traces;
  if (traces.size() > max_traces) {
    throw Error(Reason::limit_exceeded, "traces of {} rows: a job may keep those of {}",
                traces.size(), max_traces)
        .at("sweep.traces");
  }
  for (std::size_t i = 1; i < traces.size(); ++i) {
    if (traces[i] <= traces[i - 1]) {
      throw Error(Reason::invalid_argument,
                  "row {} after row {}: give the rows in ascending order, each once", traces[i],
                  traces[i - 1])
          .at(trace_path(i));
    }
  }
}

}  // namespace

const char* matrix_field(const SweepSpec& sweep) {
  return combines(sweep) ? "sweep.coefficients" : "sweep.nodal_forces";
}

void check_sweep(const records::JobSpec& spec, const EngineOptions& options) {
  const SweepSpec& sweep = *spec.sweep;
  check_loads(sweep, spec.loads.size(), static_cast<std::size_t>(options.max_sweep_basis));
  if (!std::holds_alternative<contact::ActiveSetOptions>(spec.solver)) {
    throw Error(Reason::invalid_argument,
                "a sweep is solved by the active set: ask for that, or submit the rows as load "
                "cases of a job")
        .at("solver.uzawa");
  }
  if (spec.fields) {
    throw Error(Reason::invalid_argument,
                "a sweep keeps no fields: leave them out, and solve the rows of interest as load "
                "cases of a job")
        .at("outputs");
  }
  if (sweep.tips && sweep.cases != SweepSpec::Cases::combinations) {
    throw Error(Reason::invalid_argument,
                "rows of nodal forces have no numbers of tips: leave them out, or combine loads")
        .at("sweep.tips");
  }
  if (!spec.probes.empty()) {
    throw Error(Reason::invalid_argument,
                "a sweep has no probes: leave them out, and solve the rows of interest as load "
                "cases of a job")
        .at("probes");
  }
  if (sweep.bounds && spec.without_bounds) {
    throw Error(Reason::invalid_argument,
                "the job asks for bounds of the rows and for no bounds: leave one of them out")
        .at("sweep.bounds");
  }
  check_traces(sweep, static_cast<std::size_t>(options.max_load_cases));
}

MatrixFile find_matrix(const SweepSpec& sweep, const store::Store& store,
                       const std::string& owner) {
  return errors::at(matrix_field(sweep), [&]() -> MatrixFile {
    std::string path = store::require_upload(store, sweep.upload, owner);
    const std::uint64_t values = store::array_length(path);
    return {std::move(path), values};
  });
}

std::uint64_t rows_of(const SweepSpec& sweep, std::uint64_t values, std::uint64_t columns,
                      std::uint64_t max_rows) {
  const std::string what = combines(sweep) ? " load cases" : " nodes of the mesh";
  if (values == 0 || values % columns != 0) {
    throw Error(Reason::invalid_argument,
                "the matrix has {} values, which is not a number of rows of {}: give a value for "
                "each of the {}{} in every row",
                values, columns, columns, what)
        .at(matrix_field(sweep));
  }
  const std::uint64_t rows = values / columns;
  if (rows > max_rows) {
    throw Error(Reason::limit_exceeded, "{} rows: a sweep may have {}, so split it", rows, max_rows)
        .at(matrix_field(sweep));
  }
  const auto beyond = std::lower_bound(sweep.traces.begin(), sweep.traces.end(), rows);
  if (beyond != sweep.traces.end()) {
    throw Error(Reason::invalid_argument, "there is no row {}: the rows are 0 to {}", *beyond,
                rows - 1)
        .at(trace_path(static_cast<std::size_t>(beyond - sweep.traces.begin())));
  }
  return rows;
}

std::uint64_t queued_cases(const records::JobSpec& spec, const store::Store& store,
                           const std::string& owner) {
  if (!spec.sweep) return spec.loads.size();
  try {
    return queued_cases(spec, find_matrix(*spec.sweep, store, owner).values);
  } catch (const Error&) {
    return 1;  // the job will fail when it starts
  }
}

std::uint64_t queued_cases(const records::JobSpec& spec, std::uint64_t values) {
  const std::uint64_t cost = spec.sweep->bounds ? bounded_cost : 1;
  return combines(*spec.sweep) ? parts(values, combinations_a_case / cost * spec.loads.size())
                               : parts(values, forces_a_case / cost);
}

}  // namespace anticrack::jobs
