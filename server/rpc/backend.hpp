// SPDX-License-Identifier: GPL-3.0-or-later
//
// The layers below the services.
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

/// References to the layers below, which outlive the server.
struct Backend {
  jobs::JobEngine& engine;
  meshes::MeshCatalogue& catalogue;
  operators::OperatorCache& cache;
  store::Store& store;
};

/// Limits that the services enforce, and those of the layers below that GetServerInfo reports.
struct Limits {
  std::uint64_t upload_bytes = 256u << 20;
  std::uint64_t mesh_triangles = 4'000'000;
  std::uint64_t memory_budget_bytes = 0;
  std::chrono::seconds meshing_time{600};
  /// Most connections, whatever runs on them, and most that one address may have.
  int connections = 4'096;
  int connections_an_address = 1'024;
  /// Most watchers; one that does not read holds about 4 MiB of the transport's buffers.
  int watchers = 2'000;
  /// Most uploads and block reads at a time.
  int transfers = 64;
  /// Most watches and transfers of one identity (or, without one, of one peer address).
  int streams_a_client = 1'024;
  /// Most creations that wait to be checked; each holds its request of at most 4 MiB.
  std::size_t waiting_creations = 128;
  /// Most other calls that wait for the disk.
  std::size_t waiting_calls = 4'096;
  // Limits of the layers below:
  std::size_t meshes = 10'000;
  std::size_t pending_meshes = 64;
  std::uint64_t disk_budget_bytes = 0;
  std::uint64_t mesher_memory_bytes = 0;
};

}  // namespace anticrack::rpc
