// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <charconv>
#include <deque>
#include <fstream>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
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

/// Returns the next chunk of a file; empty at its end.
using NextChunk = std::function<std::string()>;
struct Outgoing {
  v1::CreateUploadsRequest::Header header;
  NextChunk next;
};
/// Returns the next file; none at the end.
using NextFile = std::function<std::optional<Outgoing>()>;
/// Begins with the first file; called for every try to send.
using Begin = std::function<NextFile()>;

/// The chunks of a file on the disk.
class FileChunks {
 public:
  explicit FileChunks(std::filesystem::path path)
      : _path(std::move(path)), _file(_path, std::ios::binary) {
    if (std::filesystem::is_directory(_path) || !_file)
      throw std::runtime_error("cannot read " + _path.string() + ": it is not a readable file");
  }

  std::string next() {
    std::string chunk(chunk_bytes, '\0');
    _file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    if (_file.bad())
      throw std::runtime_error("cannot read " + _path.string() + ": the disk reports an error");
    chunk.resize(static_cast<std::size_t>(_file.gcount()));
    return chunk;
  }

 private:
  std::filesystem::path _path;
  std::ifstream _file;
};

v1::CreateUploadsRequest::Header header_of_msh(const std::filesystem::path& path) {
  digest::Sha256 sha256;
  std::uint64_t size = 0;
  FileChunks file(path);
  for (std::string chunk = file.next(); !chunk.empty(); chunk = file.next()) {
    sha256.add(chunk);
    size += chunk.size();
  }
  v1::CreateUploadsRequest::Header header;
  header.set_size(size);
  header.set_sha256(sha256.finish());
  header.set_kind(v1::Upload::KIND_MSH);
  return header;
}

Outgoing array_file(const std::shared_ptr<const std::vector<double>>& owner,
                    std::span<const double> values) {
  static_assert(std::endian::native == std::endian::little, "arrays are sent little-endian");
  Outgoing file;
  file.header.set_size(values.size_bytes());
  file.header.set_sha256(digest::Sha256().add(std::as_bytes(values)).finish());
  file.header.set_kind(v1::Upload::KIND_ARRAY);
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  file.next = [owner, rest = bytes]() mutable {
    std::string chunk(rest.substr(0, chunk_bytes));
    rest.remove_prefix(chunk.size());
    return chunk;
  };
  return file;
}

/// Reads and hashes the next arrays, a megabyte at a time, while those before are sent.
class ArrayFiles {
 public:
  ArrayFiles(std::size_t first, std::size_t end, const ReadArray& read)
      : _next(first), _end(end), _read(read) {
    read_next();
  }

  std::optional<Outgoing> next() {
    if (_ready.empty() && _pending.valid()) {
      _ready = _pending.get();
      read_next();
    }
    if (_ready.empty()) return std::nullopt;
    Outgoing file = std::move(_ready.front());
    _ready.pop_front();
    return file;
  }

 private:
  void read_next() {
    if (_next == _end) return;
    _pending = std::async(std::launch::async, [this] {
      std::deque<Outgoing> files;
      for (std::size_t bytes = 0; _next != _end && bytes < chunk_bytes; ++_next) {
        const auto values = std::make_shared<const std::vector<double>>(_read(_next));
        files.push_back(array_file(values, *values));
        bytes += std::span(*values).size_bytes();
      }
      return files;
    });
  }

  std::size_t _next;
  const std::size_t _end;
  const ReadArray& _read;
  std::deque<Outgoing> _ready;
  std::future<std::deque<Outgoing>> _pending;
};

// The server may refuse before everything is sent; the status then gives the reason.
grpc::Status send_once(Connection::State& state, const Begin& begin,
                       v1::CreateUploadsResponse& response, const std::stop_token& stop) {
  grpc::ClientContext context;
  authorise(state, context);
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  const auto writer = state.bulk_uploads->CreateUploads(&context, &response);
  try {
    v1::CreateUploadsRequest request;
    bool writing = true;
    const NextFile next_file = begin();
    while (writing) {
      std::optional<Outgoing> file = next_file();
      if (!file) break;
      *request.mutable_header() = std::move(file->header);
      writing = writer->Write(request);
      for (std::string chunk = file->next(); writing && !chunk.empty(); chunk = file->next()) {
        request.set_chunk(std::move(chunk));
        writing = writer->Write(request);
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
std::vector<std::string> send(Connection& connection, const Begin& begin, std::size_t count,
                              const std::stop_token& stop) {
  Connection::State& state = connection.state();
  Retries retries(state, *state.bulk);
  while (true) {
    v1::CreateUploadsResponse response;
    const grpc::Status status = send_once(state, begin, response, stop);
    if (status.ok()) {
      retries.succeeded();
      if (static_cast<std::size_t>(response.uploads_size()) != count)
        throw Error(Code::internal, "the server answered for other files than those sent");
      std::vector<std::string> names;
      for (const v1::Upload& upload : response.uploads()) names.push_back(upload.name());
      return names;
    }
    retries.wait(error_of(state, status), stop);
  }
}

/// Makes a stream of one file.
Begin once(std::function<Outgoing()> file) {
  return [file = std::move(file)] {
    return [file, sent = false]() mutable -> std::optional<Outgoing> {
      if (std::exchange(sent, true)) return std::nullopt;
      return file();
    };
  };
}

}  // namespace

std::string upload_mesh(Connection& connection, const std::filesystem::path& path,
                        const std::stop_token& stop) {
  const auto header = header_of_msh(path);
  const Begin begin = once([&] {
    const auto file = std::make_shared<FileChunks>(path);
    return Outgoing{header, [file] { return file->next(); }};
  });
  return send(connection, begin, 1, stop).front();
}

std::string upload_array(Connection& connection, std::span<const double> values,
                         const std::stop_token& stop) {
  return send(connection, once([&] { return array_file(nullptr, values); }), 1, stop).front();
}

std::vector<std::string> upload_arrays(Connection& connection, std::size_t count,
                                       const ReadArray& read, const std::stop_token& stop) {
  std::vector<std::string> names;
  for (std::size_t first = 0; first < count; first += files_a_stream) {
    const std::size_t end = std::min(count, first + files_a_stream);
    const Begin begin = [&] {
      const auto files = std::make_shared<ArrayFiles>(first, end, read);
      return [files] { return files->next(); };
    };
    try {
      const auto sent = send(connection, begin, end - first, stop);
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
  Connection::State& state = connection.state();
  return call(state, *state.uploads, &v1::UploadService::Stub::GetUpload,
              named<v1::GetUploadRequest>(name), stop);
}

v1::ListUploadsResponse list_uploads(Connection& connection, const v1::ListUploadsRequest& request,
                                     const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return call(state, *state.uploads, &v1::UploadService::Stub::ListUploads, request, stop);
}

void delete_upload(Connection& connection, const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  call(state, *state.uploads, &v1::UploadService::Stub::DeleteUpload,
       named<v1::DeleteUploadRequest>(name), stop, true);
}

}  // namespace anticrack::client
