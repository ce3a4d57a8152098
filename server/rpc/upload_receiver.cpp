// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/upload_receiver.hpp"

#include <span>
#include <utility>

#include "api/names.hpp"
#include "errors/errors.hpp"
#include "mesher/helper.hpp"
#include "rpc/block_feed.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

bool is_array(v1::Upload::Kind kind) {
  switch (kind) {
    case v1::Upload::KIND_UNSPECIFIED:
    case v1::Upload::KIND_MSH:
      return false;
    case v1::Upload::KIND_ARRAY:
      return true;
    default:
      throw Error(Reason::invalid_argument, "kind {} is unknown; use a .msh (1) or array (2)",
                  static_cast<int>(kind))
          .at("header.kind");
  }
}

/// Runs a check of the file's content.
template <class Check>
void at_chunk(const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    throw error.fields().empty() ? Error(error).at("chunk") : error;
  }
}

}  // namespace

UploadReceiver::UploadReceiver(store::Store& store, std::string owner, std::uint64_t max_bytes)
    : _store(store), _owner(std::move(owner)), _max_bytes(max_bytes) {}

void UploadReceiver::accept(const v1::CreateUploadsRequest& request) {
  std::size_t index = _complete.size();
  try {
    switch (request.part_case()) {
      case v1::CreateUploadsRequest::kHeader:
        if (_file && _received_bytes < _announced_bytes) {
          throw Error(Reason::invalid_argument, "a header before the end of the file before it")
              .at("header");
        }
        if (_file) end_file();
        index = _complete.size();
        return begin(request.header());
      case v1::CreateUploadsRequest::kChunk:
        return append(request.chunk());
      case v1::CreateUploadsRequest::PART_NOT_SET:
        break;
    }
    throw Error(Reason::invalid_argument, "a message with neither header nor chunk").at("chunk");
  } catch (Error& error) {
    drop();
    throw error.with("file", std::to_string(index));
  } catch (...) {
    drop();
    throw;
  }
}

void UploadReceiver::drop() {
  _file.reset();
  _complete.clear();
  _records.clear();
}

void UploadReceiver::begin(const v1::CreateUploadsRequest::Header& header) {
  if (_complete.size() == max_files) {
    throw Error(Reason::limit_exceeded, "more than {} files in one stream; use several", max_files)
        .at("header");
  }
  const bool array = is_array(header.kind());
  if (header.size() == 0) {
    throw array ? Error(Reason::invalid_argument, "the array has no value").at("header.size")
                : Error(Reason::mesh_invalid, "the file is empty; save the mesh as MSH 4.1 or 2.2")
                      .at("header.size");
  }
  if (array && header.size() % sizeof(double) != 0) {
    throw Error(Reason::invalid_argument,
                "an array of {} bytes: each value has 8 (f64, little-endian)", header.size())
        .at("header.size");
  }
  if (header.size() > _max_bytes) {
    throw Error(Reason::limit_exceeded,
                "a file of {} bytes: at most {} are accepted (see GetServerInfo)", header.size(),
                _max_bytes)
        .at("header.size");
  }
  if (!digest::is_sha256(header.sha256())) {
    throw Error(Reason::invalid_argument,
                "sha256 is not 64 lower-case hexadecimal digits, as sha256sum prints them")
        .at("header.sha256");
  }
  _announced_bytes = header.size();
  _received_bytes = 0;
  _announced_sha256 = header.sha256();
  _array = array ? std::optional<store::ArrayCheck>(std::in_place) : std::nullopt;
  store::Part part(_store.new_upload_path(header.size()));
  base::Descriptor file = store::open_to_write(part.path());
  _file.emplace(File{std::move(part), std::move(file)});
}

void UploadReceiver::append(const std::string& chunk) {
  if (!_file)
    throw Error(Reason::invalid_argument, "the first message must be the header").at("header");
  if (chunk.size() > max_chunk_bytes) {
    throw Error(Reason::limit_exceeded, "a chunk of {} bytes: at most {} are accepted",
                chunk.size(), max_chunk_bytes)
        .at("chunk");
  }
  if (chunk.size() > _announced_bytes - _received_bytes) {
    throw Error(Reason::invalid_argument, "more than the {} bytes that the header announced",
                _announced_bytes)
        .at("header.size");
  }
  const auto bytes = std::as_bytes(std::span(chunk));
  if (_array) at_chunk([&] { _array->add(bytes); });
  store::write_at(_file->file, _file->part.path(), _received_bytes, bytes);
  _hash.add(bytes);
  _received_bytes += chunk.size();
}

void UploadReceiver::end_file() {
  if (_received_bytes != _announced_bytes) {
    throw Error(Reason::invalid_argument, "{} of the {} bytes that the header announced",
                _received_bytes, _announced_bytes)
        .at("header.size");
  }
  std::string sha256 = std::exchange(_hash, {}).finish();
  if (sha256 != _announced_sha256) {
    throw Error(Reason::invalid_argument,
                "the bytes received have the sha256 {}, not the one announced", sha256)
        .at("header.sha256");
  }
  // Nothing but a mesh may reach gmsh, which would run a file that it takes for a script.
  if (!_array) at_chunk([&] { mesher::require_msh(_file->part.path()); });
  _complete.push_back(std::move(_file->part));
  _file.reset();
  _records.push_back({std::move(sha256), _owner, {}, _received_bytes, _array.has_value()});
}

std::vector<store::UploadRecord> UploadReceiver::complete() {
  try {
    if (!_file) throw Error(Reason::invalid_argument, "an upload without a header").at("header");
    end_file();
  } catch (Error& error) {
    const std::size_t index = _complete.size();
    drop();
    throw error.with("file", std::to_string(index));
  }
  std::vector<store::Part> files = std::move(_complete);
  std::vector<store::Upload> uploads;
  for (std::size_t i = 0; i < files.size(); ++i)
    uploads.push_back({files[i].path(), _records[i].id});
  const records::Clock::time_point now = _store.keep_uploads(uploads, _owner);
  for (store::Part& file : files) file.release();
  for (store::UploadRecord& record : _records) record.created = now;
  return std::move(_records);
}

}  // namespace anticrack::rpc
