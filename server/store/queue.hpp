// SPDX-License-Identifier: GPL-3.0-or-later
//
// The queue of jobs of several servers on one store: which jobs have not ended, and who runs which.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "errors/errors.hpp"
#include "records/job_record.hpp"

namespace anticrack::store {

/// A write for a job that this server does not run any more: another server has it, or will.
/// Nothing was written. What was computed is to be thrown away.
class JobTaken : public errors::Error {
 public:
  explicit JobTaken(const std::string& job)
      : Error(errors::Reason::in_use, "jobs/{} belongs to another server now", job) {}
};

/// What the queue says of a new job.
struct QueuedSize {
  std::uint64_t cases = 0;  ///< load cases, as admission counts them
  std::uint64_t bytes = 0;  ///< of the definition
};

/// What the queue holds, over all servers.
struct QueueTotals {
  std::uint64_t jobs = 0, bytes = 0;
  std::uint64_t own_jobs = 0, own_bytes = 0;  ///< of the owner in question
  std::uint64_t mesh_cases = 0;               ///< of the mesh in question
};

/// A part of a job's events, as its runner wrote it: `body` is that of jobs/event_codec.hpp.
struct EventRow {
  std::string job;
  int attempt = 1;
  std::uint64_t last = 0;  ///< number of its last event
  std::string body;
};

/// Where a reader of events is.
struct EventCursor {
  std::string job;
  std::uint64_t after = 0;
};

/// A part of a job that one server solves: a run of rows of a sweep, or a position of growth, which
/// counts as the row of its number.
struct Portion {
  std::uint64_t number = 0, first = 0, count = 0;  ///< first row and number of rows
  std::string request{};  ///< of a position, jobs/portion_codec.hpp; empty: of a sweep
  bool operator==(const Portion&) const = default;
};

/// The answers to a portion: `body` is that of jobs/portion_codec.hpp.
struct SolvedPortion {
  std::uint64_t number = 0;
  std::string body;
};

/// Contract:
/// 1. A job is in the queue from create() until Store::finish. At most one server runs it; a server
///    is an epoch, new with each registration, and each claim of a job is another attempt.
/// 2. Store::put(JobRecord) and Store::finish of a queued job throw JobTaken unless this server's
///    present epoch has the attempt of the record; so do they for one that was erased. A job whose
///    end this server wrote before ends once, whatever replies were lost.
/// 3. A server whose beat does not change for a lease, by the clock of the server that looks, loses
///    its jobs to others.
/// 4. A portion of a job is solved once: at most one server has it, who dies loses it as he loses
///    jobs, and what is solved stays for the next attempt, until the job has ended.
/// 5. Methods may be called from any thread and throw errors::Error (storage, busy) while the
///    database cannot be reached.
class Queue {
 public:
  virtual ~Queue() = default;

  /// Store::create, where the job is also queued: both or neither. `admit` throws where the owner
  /// or all have too much; it is asked only for a job that is new.
  virtual records::JobRecord create(const records::JobRecord& record,
                                    const std::string& fingerprint, const QueuedSize& size,
                                    const std::function<void(const QueueTotals&)>& admit) = 0;

  /// A job that this server runs from now on.
  struct Claim {
    records::JobRecord record;  ///< with its attempt and crashes
    bool cancelled = false;     ///< a client wants it to stop
  };
  /// Claims the most urgent job and others on its mesh, `count` at most. A job on one of the meshes
  /// `held` may jump ahead of others by a bounded number of turns of owners; other jobs wait 200 ms
  /// for a server that holds theirs. None of `except` is claimed, nor any after a lost lease.
  virtual std::vector<Claim> claim(std::size_t count, const std::vector<std::string>& held,
                                   const std::vector<std::string>& except) = 0;
  /// Notes that whoever has this job, or will, is to cancel it.
  virtual void cancel(const std::string& job) = 0;
  /// The same. If nobody has it, it is claimed.
  virtual std::optional<Claim> claim_to_cancel(const std::string& job) = 0;

  struct News {
    bool lost = false;                   ///< all that this server had is lost: it is a new epoch
    std::vector<std::string> cancelled;  ///< jobs of this server that are to stop
  };
  /// Shows that this server lives, and frees the jobs of those that do not. `known`: the jobs that
  /// this server runs; others that were claimed for it a while ago are given back, as the reply to
  /// the claim was lost.
  virtual News beat(const std::vector<std::string>& known) = 0;
  /// Gives back all jobs of this server but the `known`, at once. Only while no claim is under way.
  virtual void give_back(const std::vector<std::string>& known) = 0;
  /// Gives everything back and takes this server off the list. It must not claim any more.
  virtual void leave() = 0;
  /// Whether a job that has not ended is on this mesh.
  virtual bool needs(const std::string& mesh) const = 0;

  /// Writes events of jobs that this server runs; rows of others are left out, as rows that are
  /// there.
  virtual void append(const std::vector<EventRow>& rows) = 0;
  /// The rows after the cursors, in order, some megabytes at most.
  virtual std::vector<EventRow> events(const std::vector<EventCursor>& cursors) const = 0;
  /// Which of these jobs have ended.
  virtual std::vector<std::string> ended(const std::vector<std::string>& jobs) const = 0;

  /// Offers portions of a job that this server runs to all servers: all those of a sweep, or more
  /// positions of growth. What earlier attempts solved of the same portions stays. Throws JobTaken.
  virtual void spread(const std::string& job, int attempt,
                      const std::vector<Portion>& portions) = 0;
  /// A job that another server runs and that has portions which nobody has; none of `except`.
  /// Of the most urgent class goes first the owner for whom others are solving the fewest portions;
  /// of several one by chance, more often one on a mesh that is `held`. Nothing is taken yet.
  virtual std::optional<records::JobRecord> to_help(const std::vector<std::string>& held,
                                                    const std::vector<std::string>& except) = 0;
  /// Takes the first `count` portions that nobody has, or as many as there are. Returns all that
  /// this server has and has not solved: none if the job has ended or is to be cancelled.
  virtual std::vector<Portion> take_portions(const std::string& job, std::size_t count) = 0;
  /// Writes the answers to a portion; they are thrown away if this server does not have it any
  /// more.
  virtual void solved(const std::string& job, const SolvedPortion& portion) = 0;
  /// Some of these portions that are solved, by number; none: no other is.
  virtual std::vector<SolvedPortion> solved_portions(
      const std::string& job, const std::vector<std::int64_t>& missing) const = 0;
  /// Gives back the portions that this server has and has not solved.
  virtual void give_back_portions(const std::string& job) = 0;
  /// Nobody is to solve these portions of this attempt any more, by number; none: all of them.
  virtual void withdraw_portions(const std::string& job, int attempt,
                                 const std::vector<std::int64_t>& numbers) = 0;

  /// Calls `wake` on a thread of the queue whenever there may be a job to claim, or (`cancelled`)
  /// one to cancel, until listen() is called with an empty function. `wake` must be quick.
  virtual void listen(std::function<void(bool cancelled)> wake) = 0;
};

}  // namespace anticrack::store
