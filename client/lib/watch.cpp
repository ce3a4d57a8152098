// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "client/channel.hpp"
#include "client/jobs.hpp"

namespace anticrack::client {
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

}  // namespace anticrack::client
