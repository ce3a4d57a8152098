// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "mesh/mesh.hpp"

namespace anticrack::store {

/// Meshes in use, by the hash of their encoding. Thread-safe; keeps none alive.
class Triangulations {
 public:
  using Pointer = std::shared_ptr<const mesh::Mesh>;

  /// Null if it is not in use.
  Pointer find(const std::string& sha256) const {
    const std::lock_guard lock(_mutex);
    const auto found = _held.find(sha256);
    return found == _held.end() ? nullptr : found->second.lock();
  }

  /// Adds a mesh; returns the one held already if another thread was first. O(number held), seldom
  /// called.
  Pointer share(const std::string& sha256, Pointer mesh) {
    const std::lock_guard lock(_mutex);
    std::erase_if(_held, [](const auto& item) { return item.second.expired(); });
    auto& held = _held[sha256];
    if (Pointer first = held.lock()) return first;
    held = mesh;
    return mesh;
  }

  /// Removes a mesh from the table; its users keep it.
  void forget(const std::string& sha256) {
    const std::lock_guard lock(_mutex);
    _held.erase(sha256);
  }

 private:
  mutable std::mutex _mutex;
  std::unordered_map<std::string, std::weak_ptr<const mesh::Mesh>> _held;
};

}  // namespace anticrack::store
