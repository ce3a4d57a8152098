// SPDX-License-Identifier: GPL-3.0-or-later
//
// Who is next: the policy, without threads or locks.
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

#include "store/records.hpp"

namespace anticrack::jobs {

/// What can run together: load cases, or chunks of sweeps, of one mesh and one lane.
enum class Lane { active_set, lumped, consistent, sweep };
constexpr std::size_t lane_count = 4;
constexpr std::size_t index(Lane lane) noexcept { return static_cast<std::size_t>(lane); }

/// A job with load cases that no thread has taken.
struct Waiting {
  std::uint64_t number = 0;  ///< in the order of submission
  std::string mesh;
  Lane lane = Lane::active_set;
  store::Priority priority = store::Priority::normal;
  std::chrono::steady_clock::time_point since;
  int size_class = 0;  ///< of the mesh
  std::string owner{};
};

/// What a solver thread does next.
struct Turn {
  std::string mesh;
  Lane lane = Lane::active_set;
  /// Nobody has checked whether the operator is in memory. Answered by
  /// `prepared` or `absent`.
  bool probe = false;
  std::string owner{};  ///< of the mesh
};

/// Contract:
/// 1. Urgency is the class of a job's priority, 0 the most urgent; waiting `ageing` long is worth
///    one class, up to class 0. What waits for a turn on a mesh has waited since the mesh's last
///    turn at most, so that many old jobs on one mesh are no more urgent than one on another.
/// 2. Turns: owners first, the one with the most urgent work, at equal urgency the one whose turn
/// is
///    longest ago; work of an owner has waited since that turn at most. Of the owner's meshes the
///    most urgent; at equal urgency the mesh whose turn is longest ago, on it the lane whose turn
///    is longest ago. A mesh belongs to the owner of the last job on it.
/// 3. On a mesh and lane: owners in turn as in 2, by the load cases that were taken there; of the
///    owner's jobs the most urgent, at equal urgency the oldest.
/// 4. A job waits for its mesh without holding up another: only meshes that are ready, or that
///    nobody has looked for, have turns.
/// 5. One preparation at a time per mesh, owners and then their meshes as in 2; of a class of sizes
///    at most `prepared_limit` meshes are being prepared or are prepared and had no turn: each pins
///    memory, and large ones are to hold up no small one. Beyond it, up to twice as many, an owner
///    with a name who has none of them there may have one: those of others are to hold up nobody.
/// Not thread-safe. Choosing is O(meshes), the rest O(log jobs).
class Schedule {
 public:
  using Time = std::chrono::steady_clock::time_point;

  Schedule(std::chrono::milliseconds ageing, std::size_t prepared_limit)
      : _ageing(ageing), _prepared_limit(prepared_limit) {}

  /// A job whose units all wait, or that is back in the queue.
  void add(const Waiting& job);
  void remove(std::uint64_t number);  ///< does nothing if it is not there
  /// The job whose load case is taken next.
  std::optional<std::uint64_t> next_job(const std::string& mesh, Lane lane, Time now) const;
  /// A load case or chunk of the job was taken.
  void taken(std::uint64_t number, Time now);
  /// The priority of the most urgent job there, however long it has waited.
  std::optional<store::Priority> most_urgent(const std::string& mesh, Lane lane) const;

  /// Work of a lane that was begun and put down: it is there to be taken up as well.
  void park(const std::string& mesh, Lane lane, store::Priority priority);
  void unpark(const std::string& mesh, Lane lane, store::Priority priority);

  /// The mesh to prepare, which is `preparing` until `prepared`, `again` or `absent`.
  std::optional<std::string> next_to_prepare(Time now);
  void prepared(const std::string& mesh);
  void again(const std::string& mesh, Time not_before);
  void absent(const std::string& mesh);
  /// The operator was released: the next job needs the mesh prepared again.
  void let_go(const std::string& mesh);
  /// When the next mesh that was put back may be tried; empty when none is held back at `now`.
  std::optional<Time> next_retry(Time now) const;

  /// Of a mesh and its owner.
  using Excluded = std::function<bool(const std::string& mesh, const std::string& owner)>;
  /// Takes a turn; empty when no mesh has any that is not excluded.
  std::optional<Turn> next_turn(Time now, const Excluded& excluded = {});
  /// The turn ended now.
  void served(const std::string& mesh, Time now);
  /// There is a turn for any mesh.
  bool any() const { return others({}, Lane::active_set); }
  /// There is a turn for another mesh or lane, or work of this lane that was put down.
  bool others(const std::string& mesh, Lane lane) const;

 private:
  /// When an owner had the last turn or preparation.
  struct Last {
    Time time{};
    std::uint64_t number = 0;
  };
  using Lasts = std::unordered_map<std::string, Last>;
  /// By number: the first is the one that waits longest.
  using Jobs = std::map<std::uint64_t, Time>;

  struct Work {
    std::array<std::map<std::string, Jobs>, 3> jobs;  ///< by class and owner
    Lasts taken;                                      ///< by owner
    std::array<int, 3> parked{};                      ///< by class
    std::uint64_t last_turn = 0;
    bool empty() const;
  };
  enum class Stage { unknown, looking, absent, preparing, ready };
  struct Mesh {
    Stage stage = Stage::unknown;
    bool unused = false;  ///< prepared, and had no turn
    Time not_before{};
    Time served{};
    std::uint64_t last_turn = 0;
    int size_class = 0;
    std::string owner;
    std::array<Work, lane_count> lanes;
    bool empty() const;
    bool has_turns() const { return stage == Stage::ready || stage == Stage::unknown; }
  };

  /// The least goes first.
  struct Place {
    int urgency_since_turn = 0;
    std::uint64_t last_turn = 0;  ///< of the owner
    int urgency = 0;
    std::uint64_t number = 0;
    auto operator<=>(const Place&) const = default;
  };

  int urgency(std::size_t priority, Time since, Time now) const;
  /// As if nothing had waited since before `begin`.
  int urgency(const Work& work, Time begin, Time now) const;
  /// The first job of a lane, by when its owner last had what `lasts` says.
  std::optional<Place> first(const Work& work, const Lasts& lasts, Time now) const;
  static Last last_of(const Lasts& lasts, const std::string& owner);
  /// Who has the next turn.
  std::optional<std::string> next_owner(Time now, const Excluded& excluded) const;
  static bool has_turns(const std::string& id, const Mesh& mesh, const Excluded& excluded);
  void forget_if_empty(const std::string& mesh);
  /// Meshes that are prepared ahead, by the class of their size.
  struct Ahead {
    std::size_t all = 0;
    std::map<std::string, std::size_t> of_owner;
  };
  std::map<int, Ahead> prepared_ahead() const;  ///< by class of sizes
  bool may_prepare(const Ahead& ahead, const std::string& owner) const;

  std::chrono::milliseconds _ageing;
  std::size_t _prepared_limit;
  std::uint64_t _turns = 0;
  std::uint64_t _preparations = 0;
  std::map<std::string, Mesh> _meshes;
  std::unordered_map<std::uint64_t, Waiting> _jobs;
  Lasts _served, _prepared;  ///< by owner
};

}  // namespace anticrack::jobs
