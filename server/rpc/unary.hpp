// SPDX-License-Identifier: GPL-3.0-or-later
//
// Unary methods: find out who calls, refuse a request with unknown fields, run something that may
// throw errors::Error, answer with its status. `work` is given the caller:
// void(const access::Identity&).
#pragma once

#include <grpcpp/grpcpp.h>

#include <cstddef>
#include <string>
#include <utility>

#include "api/unknown_fields.hpp"
#include "rpc/edge.hpp"
#include "rpc/error_table.hpp"

namespace anticrack::rpc {

/// Of what `work` throws; OK where it returns. The request's type goes to the log with an
/// unexpected exception.
template <class Work>
grpc::Status status_of(const google::protobuf::Message& request, Work&& work) noexcept {
  try {
    std::forward<Work>(work)();
    return grpc::Status::OK;
  } catch (...) {
    return to_status(current_error(request.GetDescriptor()->name()));
  }
}

/// On gRPC's thread: for what is in memory.
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

/// On one of the edge's pools. Refuses when `limit` calls wait there.
template <class Work>
Unary* answer_on(const Edge& edge, WorkPool& pool, std::size_t limit, Context* context,
                 const google::protobuf::Message& request, Work work) noexcept {
  Unary* reactor = context->DefaultReactor();
  const grpc::Status posted = status_of(request, [&] {
    // Here and not on the pool: a stranger takes no place in its queue.
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

/// For what reads the store.
template <class Work>
Unary* look_up(Edge& edge, Context* context, const google::protobuf::Message& request,
               Work work) noexcept {
  return answer_on(edge, edge.lookups, edge.limits.waiting_calls, context, request,
                   std::move(work));
}

/// For what writes to the store.
template <class Work>
Unary* change(Edge& edge, Context* context, const google::protobuf::Message& request,
              Work work) noexcept {
  return answer_on(edge, edge.changes, edge.limits.waiting_calls, context, request,
                   std::move(work));
}

/// As change(), with a bound of their own, because their requests are large: a cancel still gets
/// through when these are refused.
template <class Work>
Unary* create(Edge& edge, Context* context, const google::protobuf::Message& request,
              Work work) noexcept {
  return answer_on(edge, edge.changes, edge.limits.waiting_creations, context, request,
                   std::move(work));
}

}  // namespace anticrack::rpc
