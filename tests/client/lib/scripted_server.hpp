// SPDX-License-Identifier: GPL-3.0-or-later
//
// A gRPC server that fails on cue: what a real one does only when it is killed at the right moment.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "anticrack/v1/upload.pb.h"
#include "client/connection.hpp"
#include "client/error.hpp"

namespace anticrack::client {

/// How one call ends.
struct Ending {
  Code code = Code::ok;
  std::string message;
  std::chrono::milliseconds retry_delay{0};  ///< asked for where above 0
};

/// What one stream of WatchJob sends, and how it ends.
struct WatchScript {
  std::vector<v1::WatchJobResponse> messages;
  Ending ending;
  bool hang = false;  ///< after the messages, until the client cancels
};

/// The same for ReadResult.
struct ReadScript {
  std::vector<v1::ReadResultResponse> messages;
  Ending ending;
};

/// PEM texts of a server with TLS; `client_roots`: who is asked for a certificate, empty: nobody.
struct ServerTls {
  std::string certificate, key, client_roots;
};

/// Plays one script a call, in order; the last one again and again. Records what it was asked.
class ScriptedServer {
 public:
  ScriptedServer() : ScriptedServer(ServerTls()) {}
  /// Without a certificate: unencrypted.
  explicit ScriptedServer(const ServerTls& tls);
  ~ScriptedServer();
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  std::vector<WatchScript> watches;
  std::vector<ReadScript> reads;
  std::vector<Ending> creations;  ///< of CreateJob
  std::vector<Ending> deletions;  ///< of DeleteJob

  std::vector<v1::WatchJobRequest> watched() const;
  std::vector<v1::ReadResultRequest> read() const;
  std::vector<v1::CreateJobRequest> created() const;
  /// "authorization" of every call of SolveService, empty where there was none.
  std::vector<std::string> authorizations() const;
  /// Bytes of the last upload and its header.
  std::string uploaded() const;
  v1::CreateUploadsRequest::Header upload_header() const;
  std::size_t largest_upload_chunk() const;

  /// Options of a connection to it that retries quickly.
  ConnectionOptions options() const;

 private:
  struct Services;
  std::unique_ptr<Services> _services;
};

/// An iteration of load case 0, with its sequence number.
v1::WatchJobResponse sample_event(std::uint64_t sequence);
v1::WatchJobResponse snapshot_event(std::uint64_t delivered);
v1::WatchJobResponse ended_event(std::uint64_t sequence);

}  // namespace anticrack::client
