// SPDX-License-Identifier: GPL-3.0-or-later
//
// CreateUploads: passes a client stream on to an UploadReceiver.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "anticrack/v1/upload.pb.h"
#include "rpc/edge.hpp"
#include "rpc/upload_receiver.hpp"

namespace anticrack::rpc {

/// The pool for changes hashes and writes each message, since a disk that makes writers wait must
/// not block one of gRPC's two threads. The next message is read when that is done, so the
/// transport holds a fast client back. `Finish` exactly once, never while an operation is being
/// started (`_operations`); a read that is pending then completes with ok = false.
class UploadStream final : public grpc::ServerReadReactor<v1::CreateUploadsRequest>,
                           public Stream,
                           public std::enable_shared_from_this<UploadStream> {
 public:
  /// `response` is filled in before OK, and must live until OnDone.
  UploadStream(Edge& edge, std::string owner, v1::CreateUploadsResponse* response);

  /// Gives the stream to the hub (which may refuse: errors::Error) and begins to read.
  void start(const std::string& client);

  void OnReadDone(bool ok) noexcept override;
  void OnCancel() noexcept override;
  void OnDone() noexcept override;

  void wake() noexcept override {}
  void tick(SteadyClock::time_point now) noexcept override;
  void end(const errors::Error& error) noexcept override;
  void abort() noexcept override {}  // end() waits for no peer

 private:
  void take(bool ok) noexcept;
  void read_next() noexcept;
  void finish(grpc::Status status) noexcept;
  void leave() noexcept;

  Edge& _edge;
  std::string _client;
  UploadReceiver _receiver;
  v1::CreateUploadsRequest _request;
  v1::CreateUploadsResponse* const _response;
  std::shared_ptr<UploadStream> _self;

  std::mutex _mutex;
  int _operations = 0;  ///< messages being handled; `Finish` waits for them
  bool _finished = false;
  SteadyClock::time_point _last_read = SteadyClock::now();
  SteadyClock::duration _waited{};  ///< time waited for the client, in all finished reads
  std::size_t _bytes = 0;           ///< received
  std::optional<grpc::Status> _end;
};

/// The reactor of CreateUploads: finds out who calls, then receives.
grpc::ServerReadReactor<v1::CreateUploadsRequest>* receive_upload(
    Edge& edge, grpc::CallbackServerContext* context, v1::CreateUploadsResponse* response) noexcept;

}  // namespace anticrack::rpc
