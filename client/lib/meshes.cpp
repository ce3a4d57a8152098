// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/meshes.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "client/channel.hpp"

namespace anticrack::client {
namespace {

constexpr std::chrono::milliseconds shortest_poll{50};
constexpr std::chrono::milliseconds longest_poll{1'000};

}  // namespace

v1::Mesh create_mesh(Connection& connection, const v1::CreateMeshRequest& request,
                     const std::stop_token& stop) {
  return call(connection, &v1::MeshService::Stub::CreateMesh, request, stop);
}

v1::Mesh get_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  return call_named(connection, &v1::MeshService::Stub::GetMesh, name, stop);
}

v1::ListMeshesResponse list_meshes(Connection& connection, const v1::ListMeshesRequest& request,
                                   const std::stop_token& stop) {
  return call(connection, &v1::MeshService::Stub::ListMeshes, request, stop);
}

v1::Mesh warm_mesh(Connection& connection, const std::string& name, bool pin,
                   const std::stop_token& stop) {
  v1::WarmMeshRequest request;
  request.set_name(name);
  request.set_pin(pin);
  return call(connection, &v1::MeshService::Stub::WarmMesh, request, stop);
}

v1::Mesh evict_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  return call_named(connection, &v1::MeshService::Stub::EvictMesh, name, stop);
}

void delete_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  call_named(connection, &v1::MeshService::Stub::DeleteMesh, name, stop, true);
}

bool settled(v1::Mesh::State state) {
  return state == v1::Mesh::STATE_READY || state == v1::Mesh::STATE_EVICTED ||
         state == v1::Mesh::STATE_FAILED;
}

v1::Mesh wait_for_mesh(Connection& connection, const std::string& name,
                       const std::function<void(const v1::Mesh&)>& seen,
                       const std::stop_token& stop,
                       const std::function<bool(const v1::Mesh&)>& enough) {
  std::chrono::milliseconds delay = shortest_poll;
  std::optional<v1::Mesh::State> last;
  std::string progress;
  while (true) {
    v1::Mesh mesh = get_mesh(connection, name, stop);
    std::string farther = mesh.progress().SerializeAsString();
    if (seen && (last != mesh.state() || progress != farther)) seen(mesh);
    last = mesh.state();
    progress = std::move(farther);
    if (settled(mesh.state()) || (enough && enough(mesh))) return mesh;
    sleep(delay, stop);
    delay = std::min(2 * delay, longest_poll);
  }
}

Block read_mesh(Connection& connection, const std::string& name, const std::stop_token& stop) {
  return read_block(connection, &v1::MeshService::Stub::ReadMesh, name, stop);
}

}  // namespace anticrack::client
