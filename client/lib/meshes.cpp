// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/meshes.hpp"

#include <algorithm>
#include <bit>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "client/channel.hpp"
#include "client/read_block.hpp"
#include "store/digest.hpp"

namespace anticrack::client {
namespace {

constexpr std::size_t chunk_bytes = 1u << 20;
constexpr std::chrono::milliseconds shortest_poll{50};
constexpr std::chrono::milliseconds longest_poll{1'000};

/// What is sent: the next chunk of it, empty at the end.
using NextChunk = std::function<std::string()>;
/// Begins again from the start, once for the hash and once for every try to send.
using Begin = std::function<NextChunk()>;

class FileChunks {
 public:
  explicit FileChunks(std::filesystem::path path)
      : _path(std::move(path)), _file(_path, std::ios::binary) {
    if (std::filesystem::is_directory(_path) || !_file) {
      throw std::runtime_error("cannot read " + _path.string() + ": it is not a readable file");
    }
  }

  std::string next() {
    std::string chunk(chunk_bytes, '\0');
    _file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    if (_file.bad()) {
      throw std::runtime_error("cannot read " + _path.string() + ": the disk reports an error");
    }
    chunk.resize(static_cast<std::size_t>(_file.gcount()));
    return chunk;
  }

 private:
  std::filesystem::path _path;
  std::ifstream _file;
};

v1::UploadMeshRequest::Header header_of(const Begin& begin) {
  store::Sha256 sha256;
  std::uint64_t size = 0;
  const NextChunk next = begin();
  for (std::string chunk = next(); !chunk.empty(); chunk = next()) {
    sha256.add(chunk);
    size += chunk.size();
  }
  v1::UploadMeshRequest::Header header;
  header.set_size(size);
  header.set_sha256(sha256.finish());
  return header;
}

// The server may refuse before everything is sent; its status then says why.
grpc::Status upload_once(Connection::State& state, const Begin& begin,
                         const v1::UploadMeshRequest::Header& header, std::string& upload,
                         const std::stop_token& stop) {
  grpc::ClientContext context;
  authorise(state, context);
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  v1::UploadMeshResponse response;
  const auto writer = state.bulk_meshes->UploadMesh(&context, &response);
  v1::UploadMeshRequest request;
  *request.mutable_header() = header;
  bool writing = writer->Write(request);
  const NextChunk next = begin();
  for (std::string chunk = next(); writing && !chunk.empty(); chunk = next()) {
    request.set_chunk(std::move(chunk));
    writing = writer->Write(request);
  }
  writer->WritesDone();
  grpc::Status status = writer->Finish();
  upload = response.upload();
  return status;
}

std::string upload(Connection& connection, v1::UploadMeshRequest::Content content,
                   const Begin& begin, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  v1::UploadMeshRequest::Header header = header_of(begin);
  header.set_content(content);
  Retries retries(state, *state.bulk);
  while (true) {
    std::string name;
    const grpc::Status status = upload_once(state, begin, header, name, stop);
    if (status.ok()) {
      retries.succeeded();
      return name;
    }
    retries.wait(error_of(state, status), stop);
  }
}

}  // namespace

std::string upload_mesh(Connection& connection, const std::filesystem::path& path,
                        const std::stop_token& stop) {
  return upload(
      connection, v1::UploadMeshRequest::CONTENT_MSH,
      [&path] {
        const auto file = std::make_shared<FileChunks>(path);
        return [file] { return file->next(); };
      },
      stop);
}

std::string upload_array(Connection& connection, std::span<const double> values,
                         const std::stop_token& stop) {
  static_assert(std::endian::native == std::endian::little, "arrays are sent little-endian");
  const std::string_view bytes(static_cast<const char*>(static_cast<const void*>(values.data())),
                               values.size_bytes());
  return upload(
      connection, v1::UploadMeshRequest::CONTENT_ARRAY,
      [bytes] {
        return [rest = bytes]() mutable {
          std::string chunk(rest.substr(0, chunk_bytes));
          rest.remove_prefix(chunk.size());
          return chunk;
        };
      },
      stop);
}

v1::Mesh create_mesh(Connection& connection, const v1::CreateMeshRequest& request,
                     const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return call(state, *state.meshes, &v1::MeshService::Stub::CreateMesh, request, stop);
}

v1::Mesh get_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return call(state, *state.meshes, &v1::MeshService::Stub::GetMesh,
              named<v1::GetMeshRequest>(name), stop);
}

v1::ListMeshesResponse list_meshes(Connection& connection, const v1::ListMeshesRequest& request,
                                   const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return call(state, *state.meshes, &v1::MeshService::Stub::ListMeshes, request, stop);
}

v1::Mesh warm_mesh(Connection& connection, const std::string& name, bool pin,
                   const std::stop_token& stop) {
  Connection::State& state = connection.state();
  v1::WarmMeshRequest request;
  request.set_name(name);
  request.set_pin(pin);
  return call(state, *state.meshes, &v1::MeshService::Stub::WarmMesh, request, stop);
}

v1::Mesh evict_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return call(state, *state.meshes, &v1::MeshService::Stub::EvictMesh,
              named<v1::EvictMeshRequest>(name), stop);
}

void delete_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  call(state, *state.meshes, &v1::MeshService::Stub::DeleteMesh, named<v1::DeleteMeshRequest>(name),
       stop, true);
}

bool settled(v1::Mesh::State state) {
  return state == v1::Mesh::STATE_READY || state == v1::Mesh::STATE_EVICTED ||
         state == v1::Mesh::STATE_FAILED;
}

v1::Mesh wait_for_mesh(Connection& connection, const std::string& name,
                       const std::function<void(const v1::Mesh&)>& seen,
                       const std::stop_token& stop) {
  std::chrono::milliseconds delay = shortest_poll;
  std::optional<v1::Mesh::State> last;
  while (true) {
    v1::Mesh mesh = get_mesh(connection, name, stop);
    if (seen && last != mesh.state()) {
      seen(mesh);
    }
    last = mesh.state();
    if (settled(mesh.state())) {
      return mesh;
    }
    sleep(delay, stop);
    delay = std::min(2 * delay, longest_poll);
  }
}

Block read_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return read_block(state, *state.bulk_meshes, &v1::MeshService::Stub::ReadMesh, name, stop);
}

}  // namespace anticrack::client
