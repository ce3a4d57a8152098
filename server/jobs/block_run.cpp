// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/block_run.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "jobs/probes.hpp"

namespace anticrack::jobs {

BlockRun::BlockRun(const std::shared_ptr<const operators::MeshOperator>& mesh_operator,
                   contact::Mass mass, int capacity, std::atomic<std::uint64_t>& iterations)
    : _capacity(capacity),
      _iterations(iterations),
      _places(static_cast<std::size_t>(capacity)),
      _block(mesh_operator, mass, capacity) {}

void BlockRun::add(const Task& task, operators::PreparedLoad load) {
  auto column = std::make_unique<Column>(Column{task, History(task, _iterations)});
  const records::JobSpec& spec = *task.job->spec;
  const int place =
      _block.add(std::move(load), std::get<contact::UzawaOptions>(spec.solver),
                 spec.fields || !spec.probes.empty(), column->history, task.job->stop.get_token());
  _places[static_cast<std::size_t>(place)] = std::move(column);
  ++_columns;
}

std::vector<EndedCase> BlockRun::step() {
  std::vector<EndedCase> ended;
  try {
    _block.step();
    tell();
    for (operators::UzawaBlock::Ended& result : _block.take_ended()) {
      const std::unique_ptr<Column> column =
          std::move(_places[static_cast<std::size_t>(result.place)]);
      --_columns;
      if (!column->abandoned) ended.push_back({column->task, outcome_of(*column, result.answer)});
    }
  } catch (...) {
    for (EndedCase& other : end_all(std::current_exception())) ended.push_back(std::move(other));
  }
  return ended;
}

void BlockRun::tell() {
  EventLog* log = nullptr;
  const auto flush = [&] {
    if (log != nullptr) log->append(_untold);
    _untold.clear();
  };
  for (const std::unique_ptr<Column>& column : _places) {
    if (!column) continue;
    if (log != &column->history.log()) {
      flush();
      log = &column->history.log();
    }
    column->history.append_new(_untold);
  }
  flush();
}

CaseOutcome BlockRun::outcome_of(const Column& column, contact::Answer& answer) {
  try {
    const LiveJob& job = *column.task.job;
    if (!answer.fields.empty()) fill_probes(*job.probes, *job.mesh_operator, answer);
    if (!job.spec->fields) answer.fields.clear();
    return solved_case(column.task, answer, column.history.history());
  } catch (...) {
    return failed_case(column.task, std::current_exception());
  }
}

std::vector<EndedCase> BlockRun::end_all(const std::exception_ptr& failure) {
  std::vector<EndedCase> ended;
  for (std::unique_ptr<Column>& column : _places) {
    if (column && !column->abandoned)
      ended.push_back({column->task, failed_case(column->task, failure)});
    column.reset();
  }
  _columns = 0;
  _broken = true;
  return ended;
}

records::Priority BlockRun::priority() const noexcept {
  records::Priority best = records::Priority::bulk;
  for (const std::unique_ptr<Column>& column : _places)
    best = column ? std::min(best, column->task.job->spec->priority) : best;
  return best;
}

std::vector<Task> BlockRun::abandon_stopped() {
  std::vector<Task> tasks;
  for (const std::unique_ptr<Column>& column : _places) {
    if (column && !column->abandoned && column->task.job->why != Stop::none) {
      column->abandoned = true;
      column->history.give_up();
      tasks.push_back(column->task);
    }
  }
  return tasks;
}

}  // namespace anticrack::jobs
