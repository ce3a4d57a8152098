// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parts that every method uses.
#pragma once

#include <grpcpp/grpcpp.h>

#include <atomic>

#include "rpc/authentication.hpp"
#include "rpc/backend.hpp"
#include "rpc/server.hpp"
#include "rpc/stream_hub.hpp"
#include "rpc/watch_group.hpp"
#include "rpc/work_pool.hpp"

namespace anticrack::rpc {

using Context = grpc::CallbackServerContext;
using Unary = grpc::ServerUnaryReactor;
template <class Response>
using Answers = grpc::ServerWriteReactor<Response>;

/// A call that is refused before it begins: it ends at once, without a message.
template <class Reactor>
class Refused final : public Reactor {
 public:
  explicit Refused(grpc::Status status) { this->Finish(std::move(status)); }
  void OnDone() noexcept override { delete this; }
};

/// Most bytes of one request, gRPC's own default; larger data travel in chunks.
constexpr int max_message_bytes = 4 << 20;

/// Whether the server still takes new meshes and jobs.
class Admission {
 public:
  /// Refuses new ones from now on.
  void close() noexcept { _closed = true; }
  /// Throws errors::Error (draining).
  void require_open() const;

 private:
  std::atomic<bool> _closed{false};
};

/// Outlives every call. gRPC's threads run GetServerInfo and pass everything else on, because a
/// call that asks the store may wait for a writer:
///   lookups  what reads records, blocks and the beginning of a watch
///   changes  what waits for the disk: creations, uploads, deletions, cancels
///   cases    what reads texts, one at a time: a case of 4 MB takes some 400 MB of memory as tables
///   hub      the messages of all watches, which take half a processor where they are many
struct Edge {
  Edge(const ServerOptions& options, const Backend& to)
      : backend(to),
        limits(options.limits),
        authentication(options.security),
        hub({limits.watchers, limits.transfers, limits.streams_a_client, options.heartbeat,
             options.stall}),
        watch_groups(hub) {}

  const Backend backend;
  const Limits limits;
  Authentication authentication;
  Admission admission;
  StreamHub hub;
  WatchGroups watch_groups;
  WorkPool lookups{2};
  WorkPool changes{4};
  WorkPool cases{1};
};

}  // namespace anticrack::rpc
