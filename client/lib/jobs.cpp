// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/jobs.hpp"

#include <fstream>
#include <optional>
#include <stdexcept>

#include "client/channel.hpp"

namespace anticrack::client {

v1::ReadCaseResponse read_case(Connection& connection, const v1::ReadCaseRequest& request,
                               const std::stop_token& stop) {
  return call(connection, &v1::CaseService::Stub::ReadCase, request, stop);
}

v1::ListCaseKeysResponse list_case_keys(Connection& connection,
                                        const v1::ListCaseKeysRequest& request,
                                        const std::stop_token& stop) {
  return call(connection, &v1::CaseService::Stub::ListCaseKeys, request, stop);
}

std::string make_uuid() {
  std::string uuid;
  if (!(std::ifstream("/proc/sys/kernel/random/uuid") >> uuid))
    throw std::runtime_error("Linux gives no random UUID: /proc is not mounted; mount it");
  return uuid;
}

v1::Job create_job(Connection& connection, const v1::JobSpec& spec, const std::string& request_id,
                   const std::stop_token& stop) {
  v1::CreateJobRequest request;
  *request.mutable_spec() = spec;
  request.set_request_id(request_id);
  return call(connection, &v1::SolveService::Stub::CreateJob, request, stop);
}

v1::Job get_job(Connection& connection, const std::string& name, const std::stop_token& stop) {
  return call_named(connection, &v1::SolveService::Stub::GetJob, name, stop);
}

v1::ListJobsResponse list_jobs(Connection& connection, const v1::ListJobsRequest& request,
                               const std::stop_token& stop) {
  return call(connection, &v1::SolveService::Stub::ListJobs, request, stop);
}

v1::Job cancel_job(Connection& connection, const std::string& name, const std::stop_token& stop) {
  return call_named(connection, &v1::SolveService::Stub::CancelJob, name, stop);
}

void delete_job(Connection& connection, const std::string& name, const std::stop_token& stop) {
  call_named(connection, &v1::SolveService::Stub::DeleteJob, name, stop, true);
}

bool ended(v1::JobStatus::State state) {
  return state == v1::JobStatus::STATE_SUCCEEDED || state == v1::JobStatus::STATE_FAILED ||
         state == v1::JobStatus::STATE_CANCELLED || state == v1::JobStatus::STATE_NOT_CONVERGED;
}

v1::Job watch_job(Connection& connection, const std::string& name, std::uint64_t after_sequence,
                  const std::function<void(const v1::WatchJobResponse&)>& event,
                  const std::stop_token& stop) {
  Connection::State& state = connection.state();
  Retries retries(state, *state.channel);
  std::uint64_t after = after_sequence;
  std::optional<v1::Job> last;
  v1::WatchJobRequest request;
  request.set_name(name);
  while (true) {
    request.set_after_sequence(after);
    const auto take = [&](const v1::WatchJobResponse& message) {
      retries.succeeded();
      if (message.has_ended()) last = message.ended();
      if (!message.has_snapshot() &&
          !message.has_heartbeat()) {  // these have no numbers of their own
        if (message.sequence() <= after) return;
        after = message.sequence();
      }
      event(message);
    };
    const grpc::Status status =
        read_stream(state, state.channel, &v1::SolveService::Stub::WatchJob, request, stop, take);
    if (last) return *std::move(last);
    const bool gone = status.error_code() == grpc::StatusCode::OUT_OF_RANGE && after != 0;
    if (!gone || stop.stop_requested()) {
      retries.wait(status, stop);
      continue;
    }
    if (state.options.notice) {
      state.options.notice("the events after number " + std::to_string(after) +
                           " are no longer there; starting again from the earliest");
    }
    after = 0;
  }
}

Block read_result(Connection& connection, const std::string& name, const std::stop_token& stop) {
  return read_block(connection, &v1::SolveService::Stub::ReadResult, name, stop);
}

v1::ServerInfo server_info(Connection& connection, const std::stop_token& stop) {
  return call(connection, &v1::ServerService::Stub::GetServerInfo, v1::GetServerInfoRequest(),
              stop);
}

}  // namespace anticrack::client
