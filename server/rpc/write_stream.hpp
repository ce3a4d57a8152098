// SPDX-License-Identifier: GPL-3.0-or-later
//
// A feed on a gRPC server stream.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "rpc/error_table.hpp"
#include "rpc/feed.hpp"
#include "rpc/stream_hub.hpp"

namespace anticrack::rpc {

/// One write in flight, `Finish` exactly once and never while a write is pending.
/// Whoever holds `_driving` is the only one to use the feed and to start an operation: the thread
/// in run(), or the write in flight, which hands it to OnWriteDone. Operations are started with no
/// lock held. The call itself keeps the object alive until OnDone; the hub's thread may hold it a
/// little longer.
template <class Response>
class WriteStream final : public grpc::ServerWriteReactor<Response>,
                          public Stream,
                          public std::enable_shared_from_this<WriteStream<Response>> {
 public:
  WriteStream(grpc::CallbackServerContext* context, StreamHub& hub,
              std::unique_ptr<Feed<Response>> feed)
      : _context(context), _hub(hub), _feed(std::move(feed)) {}

  /// Gives the stream to the hub (which may refuse: errors::Error) and begins to send.
  void start(StreamKind kind) {
    _hub.add(kind, this->shared_from_this());
    _self = this->shared_from_this();
    try {
      const std::weak_ptr<Stream> weak = _self;
      _feed->start([&hub = _hub, weak] { hub.wake(weak); });
    } catch (...) {
      const std::lock_guard lock(_mutex);
      _end = to_status(current_error("stream"));
    }
    run();
  }

  void OnWriteDone(bool ok) noexcept override {
    {
      const std::lock_guard lock(_mutex);
      _writing = false;
      if (!ok && !_end) _end = grpc::Status::CANCELLED;
    }
    run();
  }

  void OnCancel() noexcept override {
    {
      const std::lock_guard lock(_mutex);
      if (!_end) _end = grpc::Status::CANCELLED;
    }
    drive();
  }

  void OnDone() noexcept override {
    _hub.remove(*this);
    _feed.reset();
    const auto self = std::move(_self);
  }

  void wake() noexcept override { drive(); }

  void tick(SteadyClock::time_point now) noexcept override {
    bool stalled = false;
    {
      const std::lock_guard lock(_mutex);
      stalled = _writing && now - _last_write > _hub.limits().stall;
      if (!_driving && now - _last_write > _hub.limits().heartbeat) _heartbeat_due = true;
      if (!stalled && !_heartbeat_due) return;
    }
    stalled ? abort() : drive();
  }

  void end(const errors::Error& error) noexcept override {
    grpc::Status status = to_status(error);
    {
      const std::lock_guard lock(_mutex);
      if (!_asked_to_end) _asked_to_end = std::move(status);
    }
    drive();
  }

  void abort() noexcept override {
    {
      const std::lock_guard lock(_mutex);
      if (_finished || _aborting) return;
      _aborting = true;  // nobody finishes, so the context stays valid
    }
    _context->TryCancel();
    {
      const std::lock_guard lock(_mutex);
      _aborting = false;
    }
    drive();
  }

 private:
  void drive() noexcept {
    {
      const std::lock_guard lock(_mutex);
      if (_finished || _driving) {
        _again = true;
        return;
      }
      _driving = true;
    }
    run();
  }

  /// With `_driving` held; gives it up, or leaves it with a write.
  void run() noexcept {
    for (;;) {
      bool heartbeat = false;
      bool ending = false;
      {
        const std::lock_guard lock(_mutex);
        _again = false;
        heartbeat = std::exchange(_heartbeat_due, false);
        if (!_end && _asked_to_end && !_feed->ending()) _end = _asked_to_end;
        ending = _end.has_value();
      }
      if (!ending && produce(heartbeat)) {
        {
          const std::lock_guard lock(_mutex);
          _writing = true;
          _last_write = SteadyClock::now();
        }
        this->StartWrite(&_response);
        return;
      }
      grpc::Status status;
      {
        const std::lock_guard lock(_mutex);
        if (_aborting || !_end) {
          if (_again && !_aborting) continue;
          _driving = false;
          return;
        }
        _finished = true;
        status = *_end;
      }
      this->Finish(std::move(status));
      return;
    }
  }

  /// True when `_response` is to be sent; sets `_end` when the feed is at its end.
  bool produce(bool heartbeat) noexcept {
    using Next = typename Feed<Response>::Next;
    grpc::Status status;
    try {
      _response.Clear();
      switch (_feed->next(_response)) {
        case Next::message:
          return true;
        case Next::wait:
          return heartbeat && _feed->heartbeat(_response);
        case Next::end:
          break;
      }
    } catch (...) {
      status = to_status(current_error("stream"));
    }
    const std::lock_guard lock(_mutex);
    if (!_end) _end = std::move(status);
    return false;
  }

  grpc::CallbackServerContext* const _context;
  StreamHub& _hub;
  std::unique_ptr<Feed<Response>> _feed;
  Response _response;
  std::shared_ptr<WriteStream> _self;

  std::mutex _mutex;
  bool _driving = true;  ///< until start() lets go
  bool _again = false;
  bool _writing = false;
  bool _finished = false;
  bool _aborting = false;
  bool _heartbeat_due = false;
  SteadyClock::time_point _last_write = SteadyClock::now();
  std::optional<grpc::Status> _end;
  std::optional<grpc::Status> _asked_to_end;
};

/// A stream that was refused before it began.
template <class Response>
class RefusedStream final : public grpc::ServerWriteReactor<Response> {
 public:
  explicit RefusedStream(grpc::Status status) { this->Finish(std::move(status)); }
  void OnDone() noexcept override { delete this; }
};

/// The reactor of a streaming method: what `make_feed` returns, or its error.
template <class Response, class MakeFeed>
grpc::ServerWriteReactor<Response>* stream(grpc::CallbackServerContext* context, StreamHub& hub,
                                           StreamKind kind, const char* method,
                                           MakeFeed make_feed) noexcept {
  try {
    auto call = std::make_shared<WriteStream<Response>>(context, hub, make_feed());
    call->start(kind);
    return call.get();
  } catch (...) {
    return new RefusedStream<Response>(to_status(current_error(method)));
  }
}

}  // namespace anticrack::rpc
