// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <charconv>
#include <fstream>
#include <functional>
#include <future>
#include <memory>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "client/channel.hpp"
#include "client/meshes.hpp"
#include "digest/digest.hpp"

namespace anticrack::client {
namespace {

constexpr std::size_t chunk_bytes = 1u << 20;
constexpr std::size_t files_a_stream = 500;  // the server takes 1000

/// A file to send; `owner`, if any, keeps its bytes.
struct Outgoing {
  v1::CreateUploadsRequest::Header header;
  std::string_view bytes;
  std::shared_ptr<const void> owner;
};
/// Opens a file by its index; called in order, and from the first one on for every try to send.
using Open = std::function<Outgoing(std::size_t)>;

Outgoing outgoing(v1::Upload::Kind kind, std::string_view bytes,
                  std::shared_ptr<const void> owner = nullptr) {
  Outgoing file{{}, bytes, std::move(owner)};
  file.header.set_size(bytes.size());
  file.header.set_sha256(digest::Sha256().add(std::as_bytes(std::span(bytes))).finish());
  file.header.set_kind(kind);
  return file;
}

std::string_view bytes_of(std::span<const double> values) {
  static_assert(std::endian::native == std::endian::little, "arrays are sent little-endian");
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

// The server may refuse before everything is sent; the status then gives the reason.
grpc::Status send_once(Connection::State& state, const Open& open, std::size_t count,
                       v1::CreateUploadsResponse& response, const std::stop_token& stop) {
  v1::UploadService::Stub stub(state.bulk);
  grpc::ClientContext context;
  prepare(state, context);
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  const auto writer = stub.CreateUploads(&context, &response);
  try {
    v1::CreateUploadsRequest request;
    bool writing = true;
    for (std::size_t i = 0; writing && i < count; ++i) {
      Outgoing file = open(i);
      *request.mutable_header() = std::move(file.header);
      writing = writer->Write(request);
      for (; writing && !file.bytes.empty(); writing = writer->Write(request)) {
        request.set_chunk(std::string(file.bytes.substr(0, chunk_bytes)));
        file.bytes.remove_prefix(request.chunk().size());
      }
    }
  } catch (...) {  // a file cannot be read
    context.TryCancel();
    writer->Finish();
    throw;
  }
  writer->WritesDone();
  return writer->Finish();
}

/// Sends `count` files; returns their names.
std::vector<std::string> send(Connection& connection, const Open& open, std::size_t count,
                              const std::stop_token& stop) {
  Connection::State& state = connection.state();
  Retries retries(state, *state.bulk);
  while (true) {
    v1::CreateUploadsResponse response;
    const grpc::Status status = send_once(state, open, count, response, stop);
    if (!status.ok()) {
      retries.wait(status, stop);
      continue;
    }
    retries.succeeded();
    if (static_cast<std::size_t>(response.uploads_size()) != count)
      throw Error(Code::internal, "the server answered for other files than those sent");
    std::vector<std::string> names;
    for (const v1::Upload& upload : response.uploads()) names.push_back(upload.name());
    return names;
  }
}

}  // namespace

std::string upload_mesh(Connection& connection, const std::filesystem::path& path,
                        const std::stop_token& stop) {
  std::ifstream file(path, std::ios::binary);
  if (std::filesystem::is_directory(path) || !file)
    throw std::runtime_error("cannot read " + path.string() + ": it is not a readable file");
  const std::string content = (std::ostringstream() << file.rdbuf()).str();
  if (file.bad())
    throw std::runtime_error("cannot read " + path.string() + ": the disk reports an error");
  const auto open = [&](std::size_t) { return outgoing(v1::Upload::KIND_MSH, content); };
  return send(connection, open, 1, stop).front();
}

std::string upload_array(Connection& connection, std::span<const double> values,
                         const std::stop_token& stop) {
  const auto open = [values](std::size_t) {
    return outgoing(v1::Upload::KIND_ARRAY, bytes_of(values));
  };
  return send(connection, open, 1, stop).front();
}

std::vector<std::string> upload_arrays(Connection& connection, std::size_t count,
                                       const ReadArray& read, const std::stop_token& stop) {
  std::vector<std::string> names;
  for (std::size_t first = 0; first < count; first += files_a_stream) {
    const std::size_t end = std::min(count, first + files_a_stream);
    const auto begin = [&read](std::size_t index) {
      return std::async(std::launch::async, [&read, index] {
        const auto values = std::make_shared<const std::vector<double>>(read(index));
        return outgoing(v1::Upload::KIND_ARRAY, bytes_of(*values), values);
      });
    };
    std::future<Outgoing> next;  // read and hashed while the one before is sent
    const auto open = [&](std::size_t index) {
      if (index == 0) {
        next = {};  // waits for the reading of an earlier try
        next = begin(first);
      }
      Outgoing file = next.get();
      if (first + index + 1 < end) next = begin(first + index + 1);
      return file;
    };
    try {
      const auto sent = send(connection, open, end - first, stop);
      names.insert(names.end(), sent.begin(), sent.end());
    } catch (const Error& error) {
      Details details = error.details();
      if (const auto file = details.metadata.find("file"); file != details.metadata.end()) {
        const std::string& text = file->second;
        std::size_t index = 0;
        std::from_chars(text.data(), text.data() + text.size(), index);
        file->second = std::to_string(first + std::min(index, end - first - 1));
      }
      throw Error(error.code(), error.what(), std::move(details));
    }
  }
  return names;
}

v1::Upload get_upload(Connection& connection, const std::string& name,
                      const std::stop_token& stop) {
  return call_named(connection, &v1::UploadService::Stub::GetUpload, name, stop);
}

v1::ListUploadsResponse list_uploads(Connection& connection, const v1::ListUploadsRequest& request,
                                     const std::stop_token& stop) {
  return call(connection, &v1::UploadService::Stub::ListUploads, request, stop);
}

void delete_upload(Connection& connection, const std::string& name, const std::stop_token& stop) {
  call_named(connection, &v1::UploadService::Stub::DeleteUpload, name, stop, true);
}

}  // namespace anticrack::client
