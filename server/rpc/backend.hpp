// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the edge stands on.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace anticrack::jobs {
class JobEngine;
}
namespace anticrack::meshes {
class MeshCatalogue;
}
namespace anticrack::operators {
class OperatorCache;
}
namespace anticrack::store {
class Store;
}

namespace anticrack::rpc {

/// Not owned; all of it outlives the server.
struct Backend {
  jobs::JobEngine& engine;
  meshes::MeshCatalogue& catalogue;
  operators::OperatorCache& cache;
  store::Store& store;
};

/// What the edge refuses, and what GetServerInfo says of the layers below.
struct Limits {
  std::uint64_t upload_bytes = 256u << 20;
  std::uint64_t mesh_triangles = 4'000'000;
  std::uint64_t memory_budget_bytes = 0;
  std::chrono::seconds meshing_time{600};
  /// Connections, whatever runs on them, and how many of them one address may have.
  int connections = 4'096;
  int connections_an_address = 1'024;
  /// A reader that does not read holds about 4 MiB of the transport's buffers.
  int watchers = 2'000;
  /// Uploads and block reads under way.
  int transfers = 64;
  /// Of the two, how many one identity (or, without one, one peer address) may hold.
  int streams_a_client = 1'024;
  /// Creations that wait to be checked; each holds its request of at most 4 MiB.
  std::size_t waiting_creations = 128;
  /// Any other calls that wait for the disk.
  std::size_t waiting_calls = 4'096;
  // Of the layers below:
  std::size_t meshes = 10'000;
  std::size_t pending_meshes = 64;
  std::uint64_t disk_budget_bytes = 0;
  std::uint64_t mesher_memory_bytes = 0;
};

}  // namespace anticrack::rpc
