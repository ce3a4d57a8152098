// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sends a feed on a gRPC server stream.
#pragma once

#include <grpcpp/grpcpp.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "api/unknown_fields.hpp"
#include "rpc/edge.hpp"
#include "rpc/error_table.hpp"
#include "rpc/feed.hpp"

namespace anticrack::rpc {

/// There is at most one write in flight; `Finish` is called exactly once and never while a write is
/// pending. Only the holder of `_driving` uses the feed and starts an operation: the thread in
/// run(), or the write in flight, which hands it to OnWriteDone. Operations are started with no
/// lock held. The call itself keeps the object alive until OnDone; the hub's thread and the pool
/// may hold it a little longer. gRPC's threads never run the feed: the hub's thread drives a watch,
/// and the pool for lookups a transfer, which reads the disk. Both begin on that pool.
template <class Response>
class WriteStream final : public grpc::ServerWriteReactor<Response>,
                          public Stream,
                          public std::enable_shared_from_this<WriteStream<Response>> {
 public:
  using MakeFeed = std::function<std::unique_ptr<Feed<Response>>()>;

  WriteStream(grpc::CallbackServerContext* context, Edge& edge, StreamKind kind, MakeFeed make_feed)
      : _context(context), _edge(edge), _kind(kind), _make_feed(std::move(make_feed)) {}

  /// Gives the stream to the hub (which may refuse: errors::Error) and begins to send.
  void start(const std::string& client) {
    _client = client;
    _edge.hub.add(_kind, client, this->shared_from_this());
    _self = this->shared_from_this();
    try {
      _edge.lookups.post(_client, [self = _self] { self->open(); });
    } catch (...) {
      fail(to_status(current_error("stream")));
      run();
    }
  }

  void OnWriteDone(bool ok) noexcept override {
    {
      const std::lock_guard lock(_mutex);
      _writing = false;
      _driving = false;
      if (!ok && !_end) _end = grpc::Status::CANCELLED;
    }
    schedule();
  }

  void OnCancel() noexcept override {
    fail(grpc::Status::CANCELLED);
    schedule();
  }

  void OnDone() noexcept override {
    _edge.hub.remove(*this);
    std::unique_ptr<Feed<Response>> feed;
    {
      const std::lock_guard lock(_mutex);
      feed = std::move(_feed);
    }
    feed.reset();
    const auto self = std::move(_self);
  }

  void wake() noexcept override { drive(); }

  void tick(SteadyClock::time_point now) noexcept override {
    bool stalled = false;
    {
      const std::lock_guard lock(_mutex);
      stalled = _writing && now - _last_write > _edge.hub.limits().stall;
      if (!_driving && now - _last_write > _edge.hub.limits().heartbeat) _heartbeat_due = true;
      if (!stalled && !_heartbeat_due) return;
    }
    stalled ? abort() : schedule();
  }

  void end(const errors::Error& error) noexcept override {
    grpc::Status status = to_status(error);
    {
      const std::lock_guard lock(_mutex);
      if (!_asked_to_end) _asked_to_end = std::move(status);
    }
    schedule();
  }

  void abort() noexcept override {
    {
      const std::lock_guard lock(_mutex);
      if (_finished || _aborting) return;
      _aborting = true;  // the call cannot finish now, so the context stays valid
    }
    _context->TryCancel();
    {
      const std::lock_guard lock(_mutex);
      _aborting = false;
    }
    schedule();
  }

  std::uint64_t lag() const noexcept override {
    const std::lock_guard lock(_mutex);
    return _feed ? _feed->lag() : 0;
  }

 private:
  /// Makes and starts the feed, on the pool and with `_driving` held.
  void open() noexcept {
    try {
      std::unique_ptr<Feed<Response>> feed = _make_feed();
      {
        const std::lock_guard lock(_mutex);
        _feed = std::move(feed);
      }
      const std::weak_ptr<Wakeable> weak = _self;
      _feed->start([&hub = _edge.hub, weak] { hub.wake(weak); });
    } catch (...) {
      fail(to_status(current_error("stream")));
    }
    run();
  }

  void fail(grpc::Status status) noexcept {
    const std::lock_guard lock(_mutex);
    if (!_end) _end = std::move(status);
  }

  void schedule() noexcept {
    try {
      const auto self = this->shared_from_this();
      if (_kind == StreamKind::watch)
        _edge.hub.wake(self);
      else
        _edge.lookups.post(_client, [self] { self->drive(); });
    } catch (...) {  // no memory for an entry of the queue
      drive();
    }
  }

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

  /// Sends what there is. Needs `_driving`; gives it up, or hands it to a write.
  void run() noexcept {
    for (;;) {
      bool heartbeat = false;
      bool ending = false;
      {
        const std::lock_guard lock(_mutex);
        _again = false;
        heartbeat = std::exchange(_heartbeat_due, false);
        if (!_end && _asked_to_end && !(_feed && _feed->ending())) _end = _asked_to_end;
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

  /// Returns whether `_response` is to be sent; sets `_end` if the feed has ended.
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
    fail(std::move(status));
    return false;
  }

  grpc::CallbackServerContext* const _context;
  Edge& _edge;
  std::string _client;
  const StreamKind _kind;
  const MakeFeed _make_feed;
  std::unique_ptr<Feed<Response>> _feed;  ///< set and reset under the lock
  Response _response;
  std::shared_ptr<WriteStream> _self;

  mutable std::mutex _mutex;
  bool _driving = true;  ///< until open() has ended
  bool _again = false;
  bool _writing = false;
  bool _finished = false;
  bool _aborting = false;
  bool _heartbeat_due = false;
  SteadyClock::time_point _last_write = SteadyClock::now();
  std::optional<grpc::Status> _end;
  std::optional<grpc::Status> _asked_to_end;
};

/// The reactor of a streaming method: finds out who calls, refuses a request with unknown fields,
/// then sends what `make_feed` returns
/// (unique_ptr<Feed<Response>>(const access::Identity&), called on the pool), or its error.
template <class Response, class MakeFeed>
Answers<Response>* stream(Edge& edge, Context* context, StreamKind kind,
                          const google::protobuf::Message& request, MakeFeed make_feed) noexcept {
  try {
    const access::Identity who = edge.authentication.identify(*context);
    api::require_known(request);
    auto call = std::make_shared<WriteStream<Response>>(
        context, edge, kind, [make_feed, who] { return make_feed(who); });
    call->start(client_of(who, *context));
    return call.get();
  } catch (...) {
    return new Refused<Answers<Response>>(
        to_status(current_error(request.GetDescriptor()->name())));
  }
}

}  // namespace anticrack::rpc
