// SPDX-License-Identifier: GPL-3.0-or-later
//
// The policy of which job is solved next, without threads or locks.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include "meshes/queue.hpp"
#include "records/priority.hpp"

namespace anticrack::jobs {

/// Units of one mesh and one lane can run together: load cases, or (`sweep`) chunks of sweeps and
/// the positions that this server solves for another.
enum class Lane { active_set, lumped, consistent, sweep };
constexpr std::size_t lane_count = 4;
constexpr std::size_t index(Lane lane) noexcept { return static_cast<std::size_t>(lane); }

/// A job with units that no thread has taken.
struct Waiting {
  std::uint64_t number = 0;  ///< in the order of submission
  std::string mesh;
  Lane lane = Lane::active_set;
  records::Priority priority = records::Priority::normal;
  std::chrono::steady_clock::time_point since;
  std::string owner{};
};

/// The mesh and lane that a solver thread serves next.
struct Turn {
  std::string mesh;
  Lane lane = Lane::active_set;
  std::string owner{};  ///< owner of the mesh
};

/// Contract:
/// 1. Urgency is that of meshes/queue.hpp. Work that waits for a turn on a mesh has waited at most
///    since the mesh's last turn, so many old jobs on one mesh are not more urgent than one job on
///    another mesh.
/// 2. Turns: the next owner is the one with the most urgent work; at equal urgency the one whose
///    turn is longest ago. Work of an owner has waited at most since that turn. Of the owner's
///    meshes the most urgent is next; at equal urgency the mesh whose turn is longest ago, and on
///    it the lane whose turn is longest ago. A mesh belongs to the owner of the last job on it.
/// 3. On a mesh and lane owners take turns as in 2, by the units that were taken there; of the
///    owner's jobs the most urgent is next, at equal urgency the oldest.
/// 4. A job waits for its mesh without delaying another: only meshes that are ready have turns.
/// Not thread-safe. Choosing is O(meshes), the rest O(log jobs).
class Schedule {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Adds a job whose units all wait, or that is back in the queue.
  void add(const Waiting& job);
  void remove(std::uint64_t number);  ///< does nothing if the job is not there
  /// The job whose unit is to be taken next.
  std::optional<std::uint64_t> next_job(const std::string& mesh, Lane lane, Time now) const;
  /// Records that a unit of the job was taken.
  void taken(std::uint64_t number, Time now);
  /// The priority of the most urgent job there, without regard to how long it has waited.
  std::optional<records::Priority> most_urgent(const std::string& mesh, Lane lane) const;

  /// Adds work of a lane that was begun and put down, and is to be taken up again.
  void park(const std::string& mesh, Lane lane, records::Priority priority);
  void unpark(const std::string& mesh, Lane lane, records::Priority priority);

  /// Records that the operator of the mesh is in memory, until let_go().
  void prepared(const std::string& mesh) { _meshes[mesh].ready = true; }
  void let_go(const std::string& mesh);

  /// Whether a mesh or its owner is excluded.
  using Excluded = std::function<bool(const std::string& mesh, const std::string& owner)>;
  /// Takes the next turn; empty if there is none on a mesh that is not excluded.
  std::optional<Turn> next_turn(Time now, const Excluded& excluded = {});
  /// Records that a turn on the mesh ended.
  void served(const std::string& mesh, Time now);
  /// Whether there is a turn on any mesh.
  bool any() const { return others({}, Lane::active_set); }
  /// Whether there is a turn for another mesh or lane, or work of this lane that was put down.
  bool others(const std::string& mesh, Lane lane) const;

 private:
  /// Jobs by number; the first has waited longest.
  using Jobs = std::map<std::uint64_t, Time>;

  struct Work {
    std::array<std::map<std::string, Jobs>, meshes::priority_classes> jobs;  ///< by class and owner
    meshes::Lasts taken;                                                     ///< by owner
    std::array<int, meshes::priority_classes> parked{};                      ///< by class
    std::uint64_t last_turn = 0;
    bool empty() const;
  };
  struct Mesh {
    bool ready = false;
    Time served{};
    std::uint64_t last_turn = 0;
    std::string owner;
    std::array<Work, lane_count> lanes;
    bool empty() const;
  };

  /// The position in the order; the least goes first.
  struct Place {
    int urgency_since_turn = 0;
    std::uint64_t last_turn = 0;  ///< number of the owner's last turn
    int urgency = 0;
    std::uint64_t number = 0;
    auto operator<=>(const Place&) const = default;
  };

  /// Urgency of the work if nothing had waited since before `begin`.
  static int urgency(const Work& work, Time begin, Time now);
  /// The first job of a lane.
  static std::optional<Place> first(const Work& work, Time now);
  /// The owner who has the next turn.
  std::optional<std::string> next_owner(Time now, const Excluded& excluded) const;
  static bool has_turns(const std::string& id, const Mesh& mesh, const Excluded& excluded);
  void forget_if_empty(const std::string& mesh);
  std::uint64_t _turns = 0;
  std::map<std::string, Mesh> _meshes;
  std::unordered_map<std::uint64_t, Waiting> _jobs;
  meshes::Lasts _served;  ///< by owner
};

}  // namespace anticrack::jobs
