// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>

#include "mesh/mesh.hpp"
#include "operators/mesh_operator.hpp"
#include "operators/operator_cache.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {

inline std::shared_ptr<const mesh::Mesh> small_mesh(int columns = 8) {
  anticrack::testing::StructuredOptions options;
  options.columns = columns;
  options.rows = columns / 2;
  return std::make_shared<const mesh::Mesh>(anticrack::testing::structured_mesh(options));
}

/// The real factorisation behind a gate that a test opens and closes.
class GatedFactorise {
 public:
  std::shared_ptr<const MeshOperator> operator()(std::shared_ptr<const mesh::Mesh> mesh,
                                                 std::stop_token stop) {
    const int now = ++_running;
    int seen = most_at_once;
    while (seen < now && !most_at_once.compare_exchange_weak(seen, now)) {
    }
    {
      std::unique_lock lock(_mutex);
      if (obeys_stop) {
        _changed.wait(lock, stop, [&] { return _open; });
      } else {
        _changed.wait(lock, [&] { return _open; });
      }
    }
    stops_seen += stop.stop_requested() ? 1 : 0;
    --_running;
    return MeshOperator::factorise(std::move(mesh), 1, stop);
  }

  void open(bool yes = true) {
    {
      const std::lock_guard lock(_mutex);
      _open = yes;
    }
    _changed.notify_all();
  }

  std::atomic<bool> obeys_stop{true};
  std::atomic<int> most_at_once{0};
  std::atomic<int> stops_seen{0};

 private:
  std::atomic<int> _running{0};
  std::mutex _mutex;
  std::condition_variable_any _changed;
  bool _open = true;
};

}  // namespace anticrack::operators
