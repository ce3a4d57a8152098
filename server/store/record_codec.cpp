// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/record_codec.hpp"

#include <algorithm>
#include <limits>

#include "api/translations.hpp"
#include "store/records.pb.h"

namespace anticrack::store {

using errors::Error;
using errors::Reason;

Error damaged_record(const std::string& what) {
  return {Reason::storage, "its record in the database is damaged (" + what +
                               "): delete it and make it again, or restore the data folder from a "
                               "backup"};
}

namespace {

/// read(message), whose errors say what is wrong with the record.
template <class Record, class Read>
auto decoded(std::string_view bytes, const Read& read) {
  Record record;
  if (bytes.size() > std::size_t{std::numeric_limits<int>::max()} ||
      !record.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    throw damaged_record("it cannot be parsed");
  try {
    return read(record);
  } catch (const Error& error) {
    throw damaged_record(error.what());
  }
}

bool all_converged(const v1::Job& job) {
  const auto converged = [](const v1::LoadCaseAnswer& answer) {
    return answer.status() == v1::LoadCaseAnswer::STATUS_CONVERGED;
  };
  return job.has_sweep() ? job.sweep_answer().converged() == job.sweep_answer().rows()
                         : std::all_of(job.answers().begin(), job.answers().end(), converged);
}

/// Makes a job of schema version 5 one of version 6. A job whose result had expired was in a state
/// of its own, and only its timeline said how it had ended. A job was SUCCEEDED, too, if load cases
/// did not converge.
void update(v1::Job& job) {
  constexpr int expired = 7;
  if (job.state() == expired) {
    job.set_state(job.timeline().empty() ? v1::Job::STATE_SUCCEEDED
                                         : job.timeline().rbegin()->state());
    *job.mutable_expire_time() = job.end_time();
  }
  if (job.state() == v1::Job::STATE_SUCCEEDED && !all_converged(job)) {
    job.set_state(v1::Job::STATE_NOT_CONVERGED);
    if (!job.timeline().empty()) job.mutable_timeline()->rbegin()->set_state(job.state());
  }
}

}  // namespace

std::string encode(const MeshRecord& record) {
  disk::MeshRecord out;
  api::Translation<MeshRecord>::write(record, *out.mutable_mesh());
  if (const auto* refinement = std::get_if<Refinement>(&record.definition))
    api::write_field(*refinement, out, "refinement");
  else
    api::write_definition(record.definition, *out.mutable_definition());
  return api::serialized(out);
}

std::string encode(const JobRecord& record) {
  disk::JobRecord out;
  api::Translation<JobRecord>::write(record, *out.mutable_job());
  api::write_field(record.request_id, out, "request_id");
  api::write_field(record.crashes, out, "crashes");
  return api::serialized(out);
}

MeshRecord decode_mesh_record(std::string_view bytes) {
  return decoded<disk::MeshRecord>(bytes, [](const disk::MeshRecord& in) {
    MeshRecord record = api::Translation<MeshRecord>::read(in.mesh());
    if (in.has_refinement())
      record.definition = api::read_one<Refinement>(in, "refinement");
    else
      record.definition = api::read_definition(in.definition());
    return record;
  });
}

JobRecord decode_job_record(std::string_view bytes) {
  return decoded<disk::JobRecord>(bytes, [](disk::JobRecord& in) {
    if (in.job().result_state() == v1::Job::RESULT_STATE_UNSPECIFIED) update(*in.mutable_job());
    JobRecord record = api::Translation<JobRecord>::read(in.job());
    record.request_id = in.request_id();
    record.crashes = in.crashes();
    return record;
  });
}

}  // namespace anticrack::store
