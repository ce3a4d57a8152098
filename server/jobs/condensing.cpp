// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/condensing.hpp"

#include <exception>
#include <functional>
#include <list>
#include <set>
#include <utility>
#include <variant>

#include "operators/mesh_operator.hpp"
#include "stop/stop.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using Loaded = std::pair<Task, fem::Load>;

/// A stop that any of several jobs requests.
class AnyStop {
 public:
  explicit AnyStop(const std::vector<Loaded>& cases) {
    std::set<const LiveJob*> jobs;
    for (const auto& [task, load] : cases)
      if (jobs.insert(task.job.get()).second)
        _callbacks.emplace_back(task.job->stop.get_token(), [this] { _stop.request_stop(); });
  }
  std::stop_token token() const { return _stop.get_token(); }

 private:
  std::stop_source _stop;
  std::list<std::stop_callback<std::function<void()>>> _callbacks;
};

/// Condenses once; returns the cases that were interrupted by the stop of another job.
std::vector<Loaded> pass(const operators::MeshOperator& mesh_operator, std::vector<Loaded> cases,
                         Condensed& result) {
  std::vector<const fem::Load*> loads;
  loads.reserve(cases.size());
  for (const auto& [task, load] : cases) loads.push_back(&load);
  std::vector<Loaded> again;
  again.reserve(cases.size());
  result.prepared.reserve(result.prepared.size() + cases.size());
  const auto failed = [&](Loaded& loaded, const Error& error) {
    if (error.reason() == Reason::cancelled && !loaded.first.job->stop.stop_requested()) {
      again.push_back(std::move(loaded));
    } else {
      const auto failure = std::make_exception_ptr(error);
      result.ended.push_back({loaded.first, failed_case(loaded.first, failure)});
    }
  };
  const AnyStop stop(cases);
  try {
    auto entries = mesh_operator.prepare(loads, stop.token());
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (auto* load = std::get_if<operators::PreparedLoad>(&entries[i]))
        result.prepared.push_back({cases[i].first, std::move(*load)});
      else
        failed(cases[i], std::get<Error>(entries[i]));
  } catch (const Error& error) {
    for (Loaded& loaded : cases) failed(loaded, error);
  } catch (...) {
    for (const Loaded& loaded : cases)
      result.ended.push_back({loaded.first, failed_case(loaded.first, std::current_exception())});
  }
  return again;
}

}  // namespace

Condensed condense(const operators::MeshOperator& mesh_operator, const std::vector<Task>& tasks,
                   const store::Store& store) {
  Condensed result;
  std::vector<Loaded> cases;
  for (const Task& task : tasks) {
    try {
      LiveJob& job = *task.job;
      const stop::Scope scope(job.stop.get_token());
      cases.emplace_back(task, job.arrays.resolve(job.spec->loads[task.index], store));
    } catch (...) {
      result.ended.push_back({task, failed_case(task, std::current_exception())});
    }
  }
  while (!cases.empty()) cases = pass(mesh_operator, std::move(cases), result);
  return result;
}

}  // namespace anticrack::jobs
