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
Block read_block(Connection& connection,
                 std::unique_ptr<grpc::ClientReader<Response>> (Stub::*method)(grpc::ClientContext*,
                                                                               const Request&),
                 const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  BlockReceiver receiver;
  Retries retries(state, *state.bulk);
  int damaged = 0;
  Request request;
  request.set_name(name);
  while (true) {
    request.set_offset(receiver.offset());
    const auto take = [&](const Response& response) {
      if (response.has_layout()) return receiver.accept(response.layout());
      if (!response.has_chunk()) return;
      receiver.accept(response.chunk());
      if (response.chunk().data().empty()) return;  // this is no progress
      retries.succeeded();
      damaged = 0;
    };
    grpc::Status status;
    try {
      status = read_stream(state, state.bulk, method, request, stop, take);
    } catch (const Error&) {
      if (++damaged == tries_of_damaged_data) throw;
      continue;
    }
    if (receiver.complete()) return receiver.finish();
    retries.wait(status, stop);
  }
}

}  // namespace anticrack::client
