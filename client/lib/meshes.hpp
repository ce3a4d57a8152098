// SPDX-License-Identifier: GPL-3.0-or-later
//
// MeshService. Every function throws Error, and Interrupted once `stop` is requested; a lost
// connection is retried with back-off first.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "client/block.hpp"
#include "client/connection.hpp"
#include "client/error.hpp"

namespace anticrack::client {

/// Sends a .msh file in chunks of 1 MiB; returns "uploads/SHA256". Sending it again is harmless.
/// Throws std::runtime_error when the file cannot be read or changes while it is sent.
std::string upload_mesh(Connection& connection, const std::filesystem::path& path,
                        const std::stop_token& stop = {});

/// Sends values as they are (float64, little-endian) for Force.Array; returns "uploads/SHA256".
std::string upload_array(Connection& connection, std::span<const double> values,
                         const std::stop_token& stop = {});

v1::Mesh create_mesh(Connection& connection, const v1::CreateMeshRequest& request,
                     const std::stop_token& stop = {});

v1::Mesh get_mesh(Connection& connection, const std::string& name,
                  const std::stop_token& stop = {});

v1::ListMeshesResponse list_meshes(Connection& connection, const v1::ListMeshesRequest& request,
                                   const std::stop_token& stop = {});

/// Has it factorised in the background; `pin`: and kept in memory until it is evicted.
v1::Mesh warm_mesh(Connection& connection, const std::string& name, bool pin,
                   const std::stop_token& stop = {});

/// Frees its factors; the next job makes them again.
v1::Mesh evict_mesh(Connection& connection, const std::string& name,
                    const std::stop_token& stop = {});

void delete_mesh(Connection& connection, const std::string& name, const std::stop_token& stop = {});

/// Whether the server is done with a mesh: READY, EVICTED or FAILED.
bool settled(v1::Mesh::State state);

/// Asks until the mesh is settled, and tells `seen` of every new state.
v1::Mesh wait_for_mesh(Connection& connection, const std::string& name,
                       const std::function<void(const v1::Mesh&)>& seen = {},
                       const std::stop_token& stop = {});

/// Nodes, triangles and interfaces; an interrupted read goes on where it was.
Block read_mesh(Connection& connection, const std::string& name, const std::stop_token& stop = {});

}  // namespace anticrack::client
