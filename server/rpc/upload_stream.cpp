// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/upload_stream.hpp"

#include <utility>

#include "api/unknown_fields.hpp"
#include "jobs/job_engine.hpp"
#include "rpc/error_table.hpp"
#include "rpc/from_domain.hpp"

namespace anticrack::rpc {
namespace {

/// Bytes per second that an upload must reach on average once it has kept the server waiting for
/// StreamLimits::stall; slower ones would hold their places for hours.
constexpr double least_rate = 4096;

}  // namespace

UploadStream::UploadStream(Edge& edge, std::string owner, v1::CreateUploadsResponse* response)
    : _edge(edge),
      _receiver(edge.backend.store, std::move(owner), edge.limits.upload_bytes),
      _response(response) {}

void UploadStream::start(const std::string& client) {
  _client = client;
  _edge.hub.add(StreamKind::transfer, client, shared_from_this());
  _self = shared_from_this();
  {
    const std::lock_guard lock(_mutex);
    ++_operations;
  }
  read_next();
  leave();
}

void UploadStream::OnReadDone(bool ok) noexcept {
  {
    const std::lock_guard lock(_mutex);
    if (_finished) return;
    ++_operations;
    _waited += SteadyClock::now() - _last_read;
    _bytes += ok ? _request.ByteSizeLong() : 0;
  }
  try {
    _edge.changes.post(_client, [self = shared_from_this(), ok] {
      self->take(ok);
      self->leave();
    });
  } catch (...) {
    finish(to_status(current_error("CreateUploads")));
    leave();
  }
}

void UploadStream::OnCancel() noexcept { finish(grpc::Status::CANCELLED); }

void UploadStream::OnDone() noexcept {
  _edge.hub.remove(*this);
  const auto self = std::move(_self);
}

void UploadStream::tick(SteadyClock::time_point now) noexcept {
  {
    const std::lock_guard lock(_mutex);
    if (_operations > 0) return;
    const auto stall = _edge.hub.limits().stall;
    const auto waited = _waited + (now - _last_read);
    const bool slow =
        waited > stall &&
        static_cast<double>(_bytes) < least_rate * std::chrono::duration<double>(waited).count();
    if (now - _last_read <= stall && !slow) return;
  }
  end(errors::Error(errors::Reason::cancelled,
                    "the upload came at less than 4 KiB/s for too long, or not at all: "
                    "upload again over a faster connection"));
}

void UploadStream::end(const errors::Error& error) noexcept { finish(to_status(error)); }

void UploadStream::take(bool ok) noexcept {
  {
    const std::lock_guard lock(_mutex);
    if (_end) return;
  }
  try {
    if (ok) {
      api::require_known(_request);
      _receiver.accept(_request);
      read_next();
    } else {
      for (const store::UploadRecord& record : _receiver.complete())
        *_response->add_uploads() = from_domain(record, _edge.backend.engine.options().upload_ttl);
      finish(grpc::Status::OK);
    }
  } catch (...) {
    finish(to_status(current_error("CreateUploads")));
  }
}

void UploadStream::read_next() noexcept {
  {
    const std::lock_guard lock(_mutex);
    if (_end) return;
    _last_read = SteadyClock::now();
  }
  StartRead(&_request);
}

void UploadStream::finish(grpc::Status status) noexcept {
  {
    const std::lock_guard lock(_mutex);
    if (!_end) _end = std::move(status);
    ++_operations;
  }
  leave();
}

void UploadStream::leave() noexcept {
  grpc::Status status;
  {
    const std::lock_guard lock(_mutex);
    if (--_operations > 0 || !_end || _finished) return;
    _finished = true;
    status = *_end;
  }
  Finish(std::move(status));
}

grpc::ServerReadReactor<v1::CreateUploadsRequest>* receive_upload(
    Edge& edge, grpc::CallbackServerContext* context,
    v1::CreateUploadsResponse* response) noexcept {
  try {
    const access::Identity who = edge.authentication.identify(*context);
    auto upload = std::make_shared<UploadStream>(edge, who.name, response);
    upload->start(client_of(who, *context));
    return upload.get();
  } catch (...) {
    return new Refused<grpc::ServerReadReactor<v1::CreateUploadsRequest>>(
        to_status(current_error("CreateUploads")));
  }
}

}  // namespace anticrack::rpc
