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

double seconds_since(Steady::time_point start) {
  return std::chrono::duration<double>(Steady::now() - start).count();
}

/// theta* is for people to read and for Algorithm 2, and takes longer than all else at a large
/// interface: `at_hand` does not wait for it. 0 where it is not known.
double theta_star(const operators::MeshOperator& mesh_operator, bool at_hand) {
  try {
    return at_hand ? mesh_operator.known_theta_star() : mesh_operator.theta_star();
  } catch (const Error&) {
    return 0;  // Algorithm 2 tells who asks for it
  }
}

}  // namespace

std::uint64_t Preparation::begin_factorizing(LiveMesh& mesh) {
  if (!mesh.undecided) {
    mesh.undecided = true;
    mesh.factorizing = 0;
    mesh.since = Steady::now();
    ++mesh.round;
  }
  ++mesh.factorizing;
  return mesh.round;
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

bool Preparation::record_outcome(std::unique_lock<std::mutex>& lock, const std::string& id,
                                 const Outcome& outcome) {
  LiveMesh& mesh = _index.known(id);
  mesh.writing = true;
  lock.unlock();
  const bool written = write_outcome(id, outcome);
  lock.lock();
  mesh.writing = false;
  ++mesh.version;
  _changed.notify_all();
  return written;
}

/// The first of those who wait together decides the round, and records how long it took. theta* may
/// come later, from the run in the background.
void Preparation::end_factorizing(const std::string& id, std::uint64_t round, Outcome outcome,
                                  bool last_step) {
  std::unique_lock lock(_mutex);
  LiveMesh& mesh = _index.known(id);  // it is not erased before this is over
  mesh.ending = mesh.ending || last_step;
  const auto decides = [&] {
    return mesh.undecided && mesh.round == round && (outcome.measured || outcome.failure);
  };
  const auto adds = [&] {
    return outcome.measured && outcome.measured->theta_star > 0 && mesh.operators.theta_star == 0;
  };
  // One writes at a time, so that an older outcome does not overwrite a newer.
  _changed.wait(lock, [&] { return !mesh.writing || !(decides() || adds()); });
  const bool first = decides();
  if (outcome.measured && (first || adds())) {
    // True whether or not there is room on the disk to keep it, and to be seen by whoever gets the
    // operators.
    outcome.measured->seconds = first ? seconds_since(mesh.since) : mesh.operators.seconds;
    if (outcome.measured->theta_star == 0) {
      outcome.measured->theta_star = mesh.operators.theta_star;  // of the mesh, once and for all
    }
    mesh.operators = *outcome.measured;
    mesh.undecided = mesh.undecided && !first;
    record_outcome(lock, id, outcome);
  } else if (first) {
    // Where it cannot be written it is told to those who wait, and met again.
    if (record_outcome(lock, id, outcome)) {
      mesh.stage = Stage::failed;
      mesh.error = outcome.failure;
    }
    mesh.undecided = false;
  }
  if (mesh.round == round && --mesh.factorizing == 0) {
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
Preparation::Operator Preparation::factorize(const std::string& id, std::uint64_t round,
                                             std::shared_ptr<const mesh::Mesh> mesh, bool hold,
                                             const std::stop_token& stop) {
  Operator result;
  std::optional<Error> error;
  try {
    result = load(id, std::move(mesh), stop);
  } catch (const Error& thrown) {
    error = thrown;
  } catch (const std::bad_alloc&) {
    error = Error(Reason::busy, "not enough memory for this mesh now")
                .retry_after(operators::retry_delay);
  } catch (const std::exception& thrown) {
    error = Error(Reason::internal, std::string("factorising failed: ") + thrown.what());
  }
  Outcome outcome;
  if (result) {
    outcome.measured = Measured{0, theta_star(*result, hold), 0};
    outcome.measured->bytes = result->bytes();
  } else if (lasting(*error)) {
    outcome.failure = error;
  }
  if (!hold) {
    result.reset();
  }
  end_factorizing(id, round, std::move(outcome), !hold);
  if (error) {
    throw Error(*error);
  }
  return result;
}

}  // namespace anticrack::meshes
