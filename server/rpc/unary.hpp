// SPDX-License-Identifier: GPL-3.0-or-later
//
// Runs unary methods: finds out who calls, refuses a request with unknown fields, runs `work`,
// which may throw errors::Error, and answers with its status. `work` gets the caller: void(const
// access::Identity&).
#pragma once

#include <grpcpp/grpcpp.h>

#include <cstddef>
#include <string>
#include <utility>

#include "api/unknown_fields.hpp"
#include "rpc/edge.hpp"
#include "rpc/error_table.hpp"

namespace anticrack::rpc {

/// The status of what `work` throws; OK if it returns. With an unexpected exception, the request's
/// type is logged.
template <class Work>
grpc::Status status_of(const google::protobuf::Message& request, Work&& work) noexcept {
  try {
    std::forward<Work>(work)();
    return grpc::Status::OK;
  } catch (...) {
    return to_status(current_error(request.GetDescriptor()->name()));
  }
}

/// Runs `work` on gRPC's thread, for data in memory.
template <class Work>
Unary* answer(const Edge& edge, Context* context, const google::protobuf::Message& request,
              Work&& work) noexcept {
  Unary* reactor = context->DefaultReactor();
  reactor->Finish(status_of(request, [&] {
    const access::Identity who = edge.authentication.identify(*context);
    api::require_known(request);
    work(who);
  }));
  return reactor;
}

/// Runs `work` on one of the edge's pools; refuses if `limit` calls wait there.
template <class Work>
Unary* answer_on(const Edge& edge, WorkPool& pool, std::size_t limit, Context* context,
                 const google::protobuf::Message& request, Work work) noexcept {
  Unary* reactor = context->DefaultReactor();
  const grpc::Status posted = status_of(request, [&] {
    // Done here and not on the pool, so that a stranger takes no place in its queue.
    const access::Identity who = edge.authentication.identify(*context);
    const std::string client = client_of(who, *context);
    if (!pool.has_room(client, limit))
      throw errors::Error(errors::Reason::busy,
                          "too many calls wait to be taken up; try again later")
          .retry_after(std::chrono::seconds(1));
    pool.post(client, [reactor, &request, work, who] {
      reactor->Finish(status_of(request, [&] {
        api::require_known(request);
        work(who);
      }));
    });
  });
  if (!posted.ok()) reactor->Finish(posted);
  return reactor;
}

/// Runs `work` that reads the store.
template <class Work>
Unary* look_up(Edge& edge, Context* context, const google::protobuf::Message& request,
               Work work) noexcept {
  return answer_on(edge, edge.lookups, edge.limits.waiting_calls, context, request,
                   std::move(work));
}

/// Runs `work` that writes to the store.
template <class Work>
Unary* change(Edge& edge, Context* context, const google::protobuf::Message& request,
              Work work) noexcept {
  return answer_on(edge, edge.changes, edge.limits.waiting_calls, context, request,
                   std::move(work));
}

/// As change(), with a separate limit, because the requests are large: a cancel still gets through
/// when these are refused.
template <class Work>
Unary* create(Edge& edge, Context* context, const google::protobuf::Message& request,
              Work work) noexcept {
  return answer_on(edge, edge.changes, edge.limits.waiting_creations, context, request,
                   std::move(work));
}

}  // namespace anticrack::rpc
