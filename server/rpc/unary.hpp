// SPDX-License-Identifier: GPL-3.0-or-later
//
// Unary methods: run something that may throw errors::Error, answer with its status.
#pragma once

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <utility>

#include "rpc/error_table.hpp"
#include "rpc/work_thread.hpp"

namespace anticrack::rpc {

template <class Work>
grpc::Status status_of(const char* method, Work&& work) noexcept {
  try {
    std::forward<Work>(work)();
    return grpc::Status::OK;
  } catch (...) {
    return to_status(current_error(method));
  }
}

/// On gRPC's thread: for what only looks something up.
template <class Work>
grpc::ServerUnaryReactor* answer(grpc::CallbackServerContext* context, const char* method,
                                 Work&& work) noexcept {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(status_of(method, std::forward<Work>(work)));
  return reactor;
}

/// On the work thread: for what checks or sorts through much. Refuses when `limit` calls wait
/// there.
template <class Work>
grpc::ServerUnaryReactor* answer_on(WorkThread& thread, std::size_t limit,
                                    grpc::CallbackServerContext* context, const char* method,
                                    Work work) noexcept {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  const grpc::Status posted = status_of(method, [&] {
    if (thread.waiting() >= limit) {
      throw errors::Error(errors::Reason::busy, "too many requests wait to be checked")
          .retry_after(std::chrono::seconds(1));
    }
    thread.post([reactor, method, work] { reactor->Finish(status_of(method, work)); });
  });
  if (!posted.ok()) reactor->Finish(posted);
  return reactor;
}

/// Whether the server still takes new meshes and jobs.
class Admission {
 public:
  void close() noexcept { _closed = true; }
  /// Throws errors::Error (draining).
  void require_open() const;

 private:
  std::atomic<bool> _closed{false};
};

}  // namespace anticrack::rpc
