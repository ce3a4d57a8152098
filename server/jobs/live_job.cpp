// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/live_job.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using store::CaseRecord;
using store::CaseStatus;
using store::JobRecord;
using store::JobState;

/// The error with another message and other fields, the metadata kept.
Error retold(const Error& error, const std::string& message,
             const std::vector<std::string>& fields) {
  Error result(error.reason(), message);
  for (const std::string& field : fields) {
    result.at(field);
  }
  for (const auto& [key, value] : error.metadata()) {
    result.with(key, value);
  }
  return result;
}

Error case_failed(const store::JobSpec& spec, std::size_t index, const Error& error) {
  std::vector<std::string> fields;
  for (const errors::FieldViolation& violation : error.fields()) {
    fields.push_back(violation.field);
  }
  return retold(error, "load case \"" + spec.loads[index].name + "\": " + error.what(), fields);
}

}  // namespace

LiveJob::LiveJob(std::uint64_t submission, const JobRecord& record, std::size_t event_log_bytes)
    : number(submission),
      id(record.id),
      spec(std::make_shared<const store::JobSpec>(record.spec)),
      created(record.created),
      log(std::make_shared<EventLog>(event_log_bytes)),
      arrays(record.spec.loads),
      cases(record.spec.loads.size()) {}

JobSnapshot::JobSnapshot(const LiveJob& job)
    : id(job.id),
      spec(job.spec),
      created(job.created),
      state(job.state),
      started(job.started),
      final_record(job.final_record) {
  if (!final_record) {
    for (const LiveCase& live : job.cases) {
      running.push_back(live.running);
      cases.push_back(live.record);
    }
  }
}

JobRecord JobSnapshot::record() const {
  if (final_record) {
    return *final_record;
  }
  JobRecord result;
  result.id = id;
  result.spec = *spec;
  result.state = state;
  result.created = created;
  result.started = started;
  result.cases.resize(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases[i]) {
      result.cases[i] = *cases[i];
    } else if (running[i]) {
      result.cases[i].status = CaseStatus::running;
    }
  }
  return result;
}

Outcome outcome(const store::JobSpec& spec, const std::vector<LiveCase>& cases) {
  Outcome result;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CaseRecord& record = *cases[i].record;
    if (record.status == CaseStatus::cancelled) {
      return {JobState::cancelled, std::nullopt};
    }
    if (record.status == CaseStatus::failed && !result.error) {
      result = {JobState::failed, case_failed(spec, i, *record.error)};
    }
  }
  return result;
}

Error mesh_failed(const std::string& mesh, const Error& error) {
  return retold(error, "meshes/" + mesh + ": " + error.what(), {"mesh"});
}

}  // namespace anticrack::jobs
