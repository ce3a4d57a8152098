// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads the streams of ReadMesh and ReadResult: a layout and chunks, resumed by offset. For the
// sources of this folder only.
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "client/block.hpp"
#include "client/channel.hpp"

namespace anticrack::client {

/// A damaged chunk is requested again, this often in a row; then the error is thrown.
inline constexpr int tries_of_damaged_data = 3;

/// The block that a method streams, complete and checked. After a lost connection the read goes on
/// where it was. Throws Error, and Interrupted once `stop` is requested.
template <class Stub, class Request, class Response>
Block read_block(Connection::State& state, Stub& stub,
                 std::unique_ptr<grpc::ClientReader<Response>> (Stub::*method)(grpc::ClientContext*,
                                                                               const Request&),
                 const std::string& name, const std::stop_token& stop) {
  BlockReceiver receiver;
  Retries retries(state, *state.bulk);
  int damaged = 0;
  while (true) {
    Request request;
    request.set_name(name);
    request.set_offset(receiver.offset());
    grpc::ClientContext context;
    authorise(state, context);
    const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
    const auto reader = (stub.*method)(&context, request);
    try {
      Response response;
      while (reader->Read(&response)) {
        if (response.has_layout()) {
          receiver.accept(response.layout());
        } else if (response.has_chunk()) {
          receiver.accept(response.chunk());
          if (response.chunk().data().empty()) continue;  // this is no progress
          retries.succeeded();
          damaged = 0;
        }
      }
    } catch (const Error&) {
      context.TryCancel();
      reader->Finish();
      if (++damaged == tries_of_damaged_data) throw;
      continue;
    }
    const grpc::Status status = reader->Finish();
    if (receiver.complete()) return receiver.finish();
    if (stop.stop_requested()) throw Interrupted();
    retries.wait(status.ok() ? Error(Code::unavailable, "the server closed the stream early")
                             : error_of(state, status),
                 stop);
  }
}

}  // namespace anticrack::client
