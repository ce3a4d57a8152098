// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/upload_receiver.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <span>
#include <system_error>
#include <utility>

#include "api/names.hpp"
#include "errors/errors.hpp"
#include "mesher/helper.hpp"
#include "rpc/block_feed.hpp"
#include "store/array_upload.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

Error storage_error(const std::string& what) {
  const bool full = errno == ENOSPC || errno == EDQUOT;
  return Error(full ? Reason::disk_full : Reason::storage,
               what + ": " + std::generic_category().message(errno) + "; the upload is dropped")
      .retry_after(std::chrono::seconds(10));
}

bool is_array(v1::UploadMeshRequest::Content content) {
  switch (content) {
    case v1::UploadMeshRequest::CONTENT_UNSPECIFIED:
    case v1::UploadMeshRequest::CONTENT_MSH:
      return false;
    case v1::UploadMeshRequest::CONTENT_ARRAY:
      return true;
    default:
      throw Error(Reason::invalid_argument,
                  "content " + std::to_string(content) + " is unknown; use a .msh (1) or array (2)")
          .at("header.content");
  }
}

/// Nothing else may reach gmsh, which runs what it takes for a script, nor a load.
void require_content(const std::string& path, bool array) {
  try {
    if (array) {
      store::require_array(path);
    } else {
      mesher::require_msh(path);
    }
  } catch (const Error& error) {
    throw error.fields().empty() ? Error(error).at("chunk") : error;
  }
}

}  // namespace

/// A file that is removed unless it was released.
class UploadReceiver::File {
 public:
  explicit File(std::string path)
      : _path(std::move(path)),
        _descriptor(
            ::open(_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600)) {
    if (_descriptor < 0) throw storage_error("cannot create a file for the upload");
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (_descriptor >= 0) ::close(_descriptor);
    if (!_path.empty()) ::unlink(_path.c_str());
  }

  void write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(_descriptor, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) throw storage_error("cannot write the upload");
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  void close() {
    const bool synced = ::fsync(_descriptor) == 0;
    const bool closed = ::close(std::exchange(_descriptor, -1)) == 0;
    if (!synced || !closed) throw storage_error("cannot write the upload");
  }

  const std::string& path() const { return _path; }
  void release() { _path.clear(); }

 private:
  std::string _path;
  int _descriptor;
};

UploadReceiver::UploadReceiver(store::Store& store, std::string owner, std::uint64_t max_bytes)
    : _store(store), _owner(std::move(owner)), _max_bytes(max_bytes) {}

UploadReceiver::~UploadReceiver() = default;

void UploadReceiver::accept(const v1::UploadMeshRequest& request) {
  try {
    switch (request.part_case()) {
      case v1::UploadMeshRequest::kHeader:
        return begin(request.header());
      case v1::UploadMeshRequest::kChunk:
        return append(request.chunk());
      case v1::UploadMeshRequest::PART_NOT_SET:
        break;
    }
    throw Error(Reason::invalid_argument, "a message with neither header nor chunk").at("chunk");
  } catch (...) {
    _file.reset();
    throw;
  }
}

void UploadReceiver::begin(const v1::UploadMeshRequest::Header& header) {
  if (_file) {
    throw Error(Reason::invalid_argument, "a second header; only the first message has one")
        .at("header");
  }
  const bool array = is_array(header.content());
  if (header.size() == 0) {
    throw array ? Error(Reason::invalid_argument, "the array has no value").at("header.size")
                : Error(Reason::mesh_invalid, "the file is empty; a .msh begins with $MeshFormat")
                      .at("header.size");
  }
  if (array && header.size() % sizeof(double) != 0) {
    throw Error(Reason::invalid_argument, "an array of " + std::to_string(header.size()) +
                                              " bytes: each value has 8 (f64, little-endian)")
        .at("header.size");
  }
  if (header.size() > _max_bytes) {
    throw Error(Reason::limit_exceeded, "a file of " + std::to_string(header.size()) +
                                            " bytes: at most " + std::to_string(_max_bytes) +
                                            " are accepted (see GetServerInfo)")
        .at("header.size");
  }
  if (!api::is_sha256(header.sha256())) {
    throw Error(Reason::invalid_argument,
                "sha256 is not 64 lower-case hexadecimal digits, as sha256sum prints them")
        .at("header.sha256");
  }
  _announced_bytes = header.size();
  _announced_sha256 = header.sha256();
  _is_array = array;
  _file = std::make_unique<File>(_store.new_upload_path(header.size()));
}

void UploadReceiver::append(const std::string& chunk) {
  if (!_file) {
    throw Error(Reason::invalid_argument, "the first message must be the header").at("header");
  }
  if (chunk.size() > max_chunk_bytes) {
    throw Error(Reason::limit_exceeded, "a chunk of " + std::to_string(chunk.size()) +
                                            " bytes: at most " + std::to_string(max_chunk_bytes) +
                                            " are accepted")
        .at("chunk");
  }
  if (chunk.size() > _announced_bytes - _received_bytes) {
    throw Error(Reason::invalid_argument, "more than the " + std::to_string(_announced_bytes) +
                                              " bytes that the header announced")
        .at("header.size");
  }
  const auto bytes = std::as_bytes(std::span(chunk));
  _file->write(bytes);
  _hash.add(bytes);
  _received_bytes += chunk.size();
}

std::string UploadReceiver::complete() {
  const std::unique_ptr<File> file = std::move(_file);
  if (!file) throw Error(Reason::invalid_argument, "an upload without a header").at("header");
  if (_received_bytes != _announced_bytes) {
    throw Error(Reason::invalid_argument, std::to_string(_received_bytes) + " of the " +
                                              std::to_string(_announced_bytes) +
                                              " bytes that the header announced")
        .at("header.size");
  }
  std::string sha256 = _hash.finish();
  if (sha256 != _announced_sha256) {
    throw Error(Reason::invalid_argument,
                "the bytes received have the sha256 " + sha256 + ", not the one announced")
        .at("header.sha256");
  }
  file->close();
  require_content(file->path(), _is_array);
  _store.keep_upload(file->path(), sha256, _owner);
  file->release();
  return sha256;
}

}  // namespace anticrack::rpc
