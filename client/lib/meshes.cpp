// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/meshes.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "client/channel.hpp"
#include "client/read_block.hpp"
#include "store/digest.hpp"

namespace anticrack::client {
namespace {

constexpr std::size_t chunk_bytes = 1u << 20;
constexpr std::chrono::milliseconds shortest_poll{50};
constexpr std::chrono::milliseconds longest_poll{1'000};

std::ifstream open_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (std::filesystem::is_directory(path) || !file) {
    throw std::runtime_error("cannot read " + path.string() + ": it is no readable file");
  }
  return file;
}

// Empty at the end of the file.
std::string read_chunk(std::ifstream& file, const std::filesystem::path& path) {
  std::string chunk(chunk_bytes, '\0');
  file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
  if (file.bad()) {
    throw std::runtime_error("cannot read " + path.string() + ": the disk reports an error");
  }
  chunk.resize(static_cast<std::size_t>(file.gcount()));
  return chunk;
}

v1::UploadMeshRequest::Header header_of(const std::filesystem::path& path) {
  std::ifstream file = open_file(path);
  store::Sha256 sha256;
  std::uint64_t size = 0;
  for (std::string chunk = read_chunk(file, path); !chunk.empty(); chunk = read_chunk(file, path)) {
    sha256.add(chunk);
    size += chunk.size();
  }
  v1::UploadMeshRequest::Header header;
  header.set_size(size);
  header.set_sha256(sha256.finish());
  return header;
}

// The server may refuse before everything is sent; its status then says why.
grpc::Status upload_once(Connection::State& state, const std::filesystem::path& path,
                         const v1::UploadMeshRequest::Header& header, std::string& upload,
                         const std::stop_token& stop) {
  grpc::ClientContext context;
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  v1::UploadMeshResponse response;
  const auto writer = state.bulk_meshes->UploadMesh(&context, &response);
  v1::UploadMeshRequest request;
  *request.mutable_header() = header;
  bool writing = writer->Write(request);
  std::ifstream file = open_file(path);
  for (std::string chunk = read_chunk(file, path); writing && !chunk.empty();
       chunk = read_chunk(file, path)) {
    request.set_chunk(std::move(chunk));
    writing = writer->Write(request);
  }
  writer->WritesDone();
  grpc::Status status = writer->Finish();
  upload = response.upload();
  return status;
}

}  // namespace

std::string upload_mesh(Connection& connection, const std::filesystem::path& path,
                        const std::stop_token& stop) {
  Connection::State& state = connection.state();
  const v1::UploadMeshRequest::Header header = header_of(path);
  Retries retries(state);
  while (true) {
    std::string upload;
    const grpc::Status status = upload_once(state, path, header, upload, stop);
    if (status.ok()) {
      retries.succeeded();
      return upload;
    }
    retries.wait(error_of(state, status), stop);
  }
}

v1::Mesh create_mesh(Connection& connection, const v1::CreateMeshRequest& request,
                     const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return call(state, *state.meshes, &v1::MeshService::Stub::CreateMesh, request, stop);
}

v1::Mesh get_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  Connection::State& state = connection.state();
  v1::GetMeshRequest request;
  request.set_name(name);
  return call(state, *state.meshes, &v1::MeshService::Stub::GetMesh, request, stop);
}

v1::ListMeshesResponse list_meshes(Connection& connection, const v1::ListMeshesRequest& request,
                                   const std::stop_token& stop) {
  Connection::State& state = connection.state();
  return call(state, *state.meshes, &v1::MeshService::Stub::ListMeshes, request, stop);
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
