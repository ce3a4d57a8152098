// SPDX-License-Identifier: GPL-3.0-or-later
//
// Preparation, second half: operators of a mesh that has a triangulation.
#include <chrono>
#include <new>
#include <utility>

#include "meshes/lasting.hpp"
#include "meshes/preparation.hpp"

namespace anticrack::meshes {

namespace {

using errors::Error;
using errors::Reason;
using store::MeshRecord;
using store::MeshState;
using Steady = std::chrono::steady_clock;

constexpr std::chrono::milliseconds retry_delay{1000};

double seconds_since(Steady::time_point start) {
  return std::chrono::duration<double>(Steady::now() - start).count();
}

}  // namespace

void Preparation::begin_factorizing(LiveMesh& mesh) {
  if (mesh.factorizing++ == 0) {
    mesh.undecided = true;
    mesh.since = Steady::now();
  }
}

bool Preparation::write_outcome(const std::string& id, const Outcome& outcome) {
  try {
    MeshRecord record = stored(id);
    if (outcome.failure) {
      record.state = MeshState::failed;
      record.error = outcome.failure;
    } else {
      record.operator_bytes = outcome.measured->bytes;
      record.theta_star = outcome.measured->theta_star;
      record.factorize_seconds = outcome.measured->seconds;
    }
    _store.put(record);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// The first of those who wait together records the outcome and how long it took.
void Preparation::end_factorizing(const std::string& id, Outcome outcome, bool last_step) {
  std::unique_lock lock(_mutex);
  LiveMesh& mesh = _index.known(id);  // it is not erased before this is over
  mesh.ending = mesh.ending || last_step;
  const bool first = (outcome.measured || outcome.failure) && std::exchange(mesh.undecided, false);
  if (first) {
    if (outcome.measured) {
      // True whether or not there is room on the disk to keep it, and to be seen by whoever gets
      // the operators.
      outcome.measured->seconds = seconds_since(mesh.since);
      mesh.operators = *outcome.measured;
    }
    lock.unlock();
    const bool written = write_outcome(id, outcome);
    lock.lock();
    // A failure that could not be written is told to those who wait, and met again.
    if (outcome.failure && written) {
      mesh.stage = Stage::failed;
      mesh.error = outcome.failure;
    }
    ++mesh.version;
  }
  if (--mesh.factorizing == 0) {
    mesh.undecided = false;
  }
  _changed.notify_all();
}

Preparation::Operator Preparation::load(const std::string& id,
                                        std::shared_ptr<const mesh::Mesh> mesh,
                                        const std::stop_token& stop) {
  std::unique_lock lock(_mutex);
  const std::string sha256 = _index.known(id).sha256;
  lock.unlock();
  Operator result = _cache.find(sha256);
  if (!result) {
    mesh = mesh ? std::move(mesh) : _store.triangulation(sha256);
    if (!mesh) {
      throw Error(Reason::storage, "the triangulation of meshes/" + id +
                                       " is not in the data folder: delete the mesh and create it "
                                       "again");
    }
    result = _cache.acquire(sha256, std::move(mesh), stop);
  }
  lock.lock();
  if (std::exchange(_index.known(id).pin, false)) {
    _cache.pin(sha256);  // cannot go before: it is held here
  }
  return result;
}

/// Ends what begin_factorizing began. Without `hold` (the last step of a run in the background) the
/// operators are let go before anybody is told that they are there, and null is returned.
Preparation::Operator Preparation::factorize(const std::string& id,
                                             std::shared_ptr<const mesh::Mesh> mesh, bool hold,
                                             const std::stop_token& stop) {
  Operator result;
  std::optional<Error> error;
  try {
    result = load(id, std::move(mesh), stop);
  } catch (const Error& thrown) {
    error = thrown;
  } catch (const std::bad_alloc&) {
    error = Error(Reason::busy, "not enough memory for this mesh now").retry_after(retry_delay);
  } catch (const std::exception& thrown) {
    error = Error(Reason::internal, std::string("factorising failed: ") + thrown.what());
  }
  Outcome outcome;
  if (result) {
    outcome.measured = Measured{result->bytes(), result->theta_star(), 0};
  } else if (lasting(*error)) {
    outcome.failure = error;
  }
  if (!hold) {
    result.reset();
  }
  end_factorizing(id, std::move(outcome), !hold);
  if (error) {
    throw Error(*error);
  }
  return result;
}

}  // namespace anticrack::meshes
