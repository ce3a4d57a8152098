// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "client/channel.hpp"
#include "client/jobs.hpp"

namespace anticrack::client {
namespace {

/// The position that the streams have reached.
struct Position {
  std::uint64_t after;
  std::optional<v1::Job> last;

  /// Whether this message is new. Snapshots and heartbeats have no numbers of their own.
  bool take(const v1::WatchJobResponse& message) {
    if (message.has_ended()) last = message.ended();
    const bool numbered = !message.has_snapshot() && !message.has_heartbeat();
    const bool news = !numbered || message.sequence() > after;
    if (numbered && news) after = message.sequence();
    return news;
  }
};

}  // namespace

v1::Job watch_job(Connection& connection, const std::string& name, std::uint64_t after_sequence,
                  const std::function<void(const v1::WatchJobResponse&)>& event,
                  const std::stop_token& stop) {
  Connection::State& state = connection.state();
  Retries retries(state, *state.channel);
  Position position{after_sequence, std::nullopt};
  v1::WatchJobRequest request;
  request.set_name(name);
  while (true) {
    request.set_after_sequence(position.after);
    const auto take = [&](const v1::WatchJobResponse& message) {
      retries.succeeded();
      if (position.take(message)) event(message);
    };
    const grpc::Status status =
        read_stream(state, state.channel, &v1::SolveService::Stub::WatchJob, request, stop, take);
    if (position.last) return *std::move(position.last);
    const bool gone = status.error_code() == grpc::StatusCode::OUT_OF_RANGE && position.after != 0;
    if (!gone || stop.stop_requested()) {
      retries.wait(status, stop);
      continue;
    }
    if (state.options.notice) {
      state.options.notice("the events after number " + std::to_string(position.after) +
                           " are no longer there; starting again from the earliest");
    }
    position.after = 0;
  }
}

}  // namespace anticrack::client
