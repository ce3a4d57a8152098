// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/sweep_chunk.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "contact/answer.hpp"
#include "contact/sweep_columns.hpp"
#include "errors/placed.hpp"
#include "jobs/case_outcome.hpp"
#include "jobs/sweep_result.hpp"
#include "jobs/trace_arrays.hpp"
#include "operators/mesh_operator.hpp"
#include "stop/stop.hpp"
#include "store/array_upload.hpp"

namespace anticrack::jobs {

namespace {

using contact::SweepColumns;
using errors::Error;
using errors::Reason;

void add_new(const std::string& warning, std::vector<std::string>& warnings) {
  if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(warning);
}

/// Rows [first, first + count) of a job's matrix.
class ChunkRows {
 public:
  explicit ChunkRows(const Task& task)
      : _job(*task.job),
        _plan(_job.sweep->plan),
        _first(_plan.first_row(task.index)),
        _count(_plan.rows_in(task.index)),
        _stop(_job.stop.get_token()),
        _columns(std::make_shared<SweepColumns>(unsolved_rows(_job, _count))) {}

  const std::shared_ptr<SweepColumns>& columns() const noexcept { return _columns; }

  SweepChunk combinations() {
    const std::vector<double> values = read(_first, _count);
    const operators::LoadBasis& basis = *_job.sweep->basis;
    require_complete(mesh_operator().sweep(basis, values, options(), *_columns, _start, _stop));
    return finish([&](std::size_t row) {
      const auto coefficients = std::span(values).subspan(row * _plan.columns);
      return mesh_operator().combine(basis, coefficients.first(_plan.columns));
    });
  }

  SweepChunk nodal_forces() {
    std::vector<operators::PreparedLoad> loads = prepare();
    require_complete(mesh_operator().sweep(loads, options(), *_columns, _start, _stop));
    return finish([&](std::size_t row) { return loads[row]; });
  }

  /// The reasons why rows have no bounds, and other warnings.
  const std::vector<std::string>& warnings() const noexcept { return _warnings; }

 private:
  const operators::MeshOperator& mesh_operator() const { return *_job.mesh_operator; }
  const contact::ActiveSetOptions& options() const {
    return std::get<contact::ActiveSetOptions>(_job.spec->solver);
  }

  static void require_complete(bool complete) {
    if (!complete) throw Error(Reason::cancelled, "the job was stopped");
  }

  Error in_row(std::uint64_t row, const std::string& what, Reason reason) const {
    return Error(reason, "row {} of the matrix: {}", row, what).at(matrix_field(*_job.spec->sweep));
  }

  std::vector<double> read(std::uint64_t row, std::size_t rows) const {
    std::vector<double> values =
        store::read_array_part(_plan.matrix, row * _plan.columns, rows * _plan.columns);
    const auto bad = std::find_if(values.begin(), values.end(),
                                  [](double value) { return !std::isfinite(value); });
    if (bad != values.end()) {
      const auto index = static_cast<std::size_t>(bad - values.begin());
      throw in_row(
          row + index / _plan.columns,
          fmt::format("column {} is {}; all values must be finite", index % _plan.columns, *bad),
          Reason::invalid_argument);
    }
    return values;
  }

  std::vector<operators::PreparedLoad> prepare() const {
    std::vector<fem::Load> loads(_count);
    std::vector<const fem::Load*> pointers;
    for (std::size_t i = 0; i < _count; ++i) {
      auto values = std::make_shared<const std::vector<double>>(read(_first + i, 1));
      loads[i].force = fem::Array{{}, false, std::move(values)};
      pointers.push_back(&loads[i]);
    }
    std::vector<operators::PreparedLoad> prepared;
    for (auto& entry : mesh_operator().prepare(pointers, _stop)) {
      if (const auto* error = std::get_if<Error>(&entry)) {
        throw error->reason() == Reason::cancelled
            ? *error
            : in_row(_first + prepared.size(), error->what(), error->reason());
      }
      prepared.push_back(std::move(std::get<operators::PreparedLoad>(entry)));
    }
    return prepared;
  }

  /// `load(i)`: the load of row _first + i.
  template <class Load>
  SweepChunk finish(const Load& load) {
    if (_job.spec->sweep->bounds) add_bounds(load);
    return spool(load);
  }

  contact::Answer solve(const operators::PreparedLoad& load) const {
    return solve_quietly(_job, mesh_operator(), load);
  }

  /// Computes bounds, as for load cases, of the rows that converged and do not share theirs; a few
  /// rows are estimated together.
  template <class Load>
  void add_bounds(const Load& load) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < _count; ++i) {
      if (_columns->status[i] == contact::Status::converged &&
          std::isnan(_columns->energy_lower[i]))
        rows.push_back(i);
      if (rows.empty() || (rows.size() < mesh_operator().estimated_together() && i + 1 < _count))
        continue;
      add_bounds(load, rows);
      rows.clear();
    }
  }

  template <class Load>
  void add_bounds(const Load& load, const std::vector<std::size_t>& rows) {
    std::vector<operators::PreparedLoad> loads;
    std::vector<contact::Answer> answers;
    for (const std::size_t i : rows) {
      loads.push_back(load(i));
      answers.push_back(solve(loads.back()));
    }
    std::vector<operators::MeshOperator::Estimate> estimates;
    for (std::size_t k = 0; k < rows.size(); ++k)
      estimates.push_back({&loads[k], &answers[k], _stop});
    mesh_operator().estimate(estimates);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (estimates[k].failure) std::rethrow_exception(estimates[k].failure);
      _columns->take_bounds(rows[k], answers[k]);
      if (!answers[k].no_bracket.empty())
        add_new("rows without bounds: " + answers[k].no_bracket, _warnings);
      for (const std::string& warning : answers[k].warnings) add_new(warning, _warnings);
    }
  }

  /// Writes the columns, and the traces of the rows that keep them, to the spool.
  template <class Load>
  SweepChunk spool(const Load& load) const {
    const std::vector<std::uint32_t>& rows = _job.spec->sweep->traces;
    records::BlockBuilder traces;
    auto row = std::lower_bound(rows.begin(), rows.end(), _first);
    for (; row != rows.end() && *row < _first + _count; ++row) {
      add_traces(traces, arrays::row_traces(*row),
                 solve(load(static_cast<std::size_t>(*row - _first))).traces);
    }
    return {_job.spool->append(chunk_arrays(*_columns).bytes), spooled(*_job.spool, traces.take())};
  }

  const LiveJob& _job;
  const SweepPlan& _plan;
  const std::uint64_t _first;
  const std::size_t _count;
  const std::stop_token _stop;
  std::shared_ptr<SweepColumns> _columns;
  std::vector<char> _start;  ///< empty: every chunk begins with all contacts closed
  std::vector<std::string> _warnings;
};

records::SweepRecord record_of(const SweepColumns& columns) {
  records::SweepRecord record;
  for (std::size_t i = 0; i < columns.rows(); ++i) {
    record.most_steps = std::max(record.most_steps, columns.steps[i]);
    if (columns.status[i] == contact::Status::converged) {
      ++record.converged;
      record.worst_kkt = std::max(record.worst_kkt, columns.kkt[i]);
    } else {
      ++record.not_converged;
    }
  }
  return record;
}

std::uint64_t steps_of(const SweepColumns& columns) {
  std::uint64_t steps = 0;
  for (const std::int32_t count : columns.steps) steps += static_cast<std::uint64_t>(count);
  return steps;
}

}  // namespace

std::shared_ptr<const operators::LoadBasis> condense_basis(
    LiveJob& job, const operators::MeshOperator& mesh_operator, const store::Store& store) {
  const stop::Scope scope(job.stop.get_token());
  std::vector<fem::Load> loads;
  std::vector<const fem::Load*> pointers;
  loads.reserve(job.spec->loads.size());
  for (const fem::Load& load : job.spec->loads) {
    loads.push_back(errors::below(fmt::format("load_cases[{}]", loads.size()),
                                  [&] { return job.arrays.resolve(load, store); }));
    pointers.push_back(&loads.back());
  }
  return mesh_operator.basis(pointers, job.stop.get_token(), job.spec->sweep->bounds,
                             job.sweep->plan.rows, job.spec->sweep->tips);
}

EndedChunk solve_chunk(const Task& task, std::atomic<std::uint64_t>& iterations) {
  EndedChunk ended{task};
  const stop::Scope scope(task.job->stop.get_token());
  try {
    ChunkRows rows(task);
    ended.solved = task.job->sweep->basis ? rows.combinations() : rows.nodal_forces();
    ended.columns = rows.columns();
    const SweepColumns& columns = *ended.columns;
    ended.record = record_of(columns);
    ended.record.warnings = rows.warnings();
    const auto elapsed = std::chrono::steady_clock::now() - task.taken;
    ended.record.solve_time = elapsed;
    iterations.fetch_add(steps_of(columns), std::memory_order_relaxed);
  } catch (...) {
    const Error error = error_of(std::current_exception());
    if (error.reason() != Reason::cancelled) ended.failure = error;
  }
  return ended;
}

void add(records::SweepRecord& sum, const records::SweepRecord& rows) {
  sum.converged += rows.converged;
  sum.not_converged += rows.not_converged;
  sum.failed += rows.failed;
  sum.most_steps = std::max(sum.most_steps, rows.most_steps);
  sum.worst_kkt = std::max(sum.worst_kkt, rows.worst_kkt);
  sum.solve_time += rows.solve_time;
  for (const std::string& warning : rows.warnings) add_new(warning, sum.warnings);
}

}  // namespace anticrack::jobs
