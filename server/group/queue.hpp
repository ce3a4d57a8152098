// SPDX-License-Identifier: GPL-3.0-or-later
//
// The queue of jobs in PostgreSQL.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "group/leases.hpp"
#include "postgres/listener.hpp"
#include "postgres/pool.hpp"
#include "store/queue.hpp"

namespace anticrack::group {

/// One statement a method, so that nothing is half done and no lock outlives a network: but
/// create(), where the owner's lock comes first, and the end of a job, which comes after its
/// result.
class Queue final : public store::Queue {
 public:
  /// `name`: of this server, the same after its restart; no two servers may have one. If there is
  /// an earlier epoch of it, that process has died, and the jobs it ran count a crash.
  Queue(postgres::Pool& pool, std::string name);

  records::JobRecord create(const records::JobRecord& record, const std::string& fingerprint,
                            const store::QueuedSize& size,
                            const std::function<void(const store::QueueTotals&)>& admit) override;
  std::vector<Claim> claim(std::size_t count, const std::vector<std::string>& held,
                           const std::vector<std::string>& except) override;
  void cancel(const std::string& job) override;
  std::optional<Claim> claim_to_cancel(const std::string& job) override;
  News beat(const std::vector<std::string>& known) override;
  void give_back(const std::vector<std::string>& known) override;
  void leave() override;
  bool needs(const std::string& mesh) const override;
  void append(const std::vector<store::EventRow>& rows) override;
  std::vector<store::EventRow> events(
      const std::vector<store::EventCursor>& cursors) const override;
  std::vector<std::string> ended(const std::vector<std::string>& jobs) const override;
  void spread(const std::string& job, int attempt,
              const std::vector<store::Portion>& portions) override;
  std::optional<records::JobRecord> to_help(const std::vector<std::string>& held,
                                            const std::vector<std::string>& except) override;
  std::vector<store::Portion> take_portions(const std::string& job, std::size_t count) override;
  void solved(const std::string& job, const store::SolvedPortion& portion) override;
  std::vector<store::SolvedPortion> solved_portions(
      const std::string& job, const std::vector<std::int64_t>& missing) const override;
  void give_back_portions(const std::string& job) override;
  void withdraw_portions(const std::string& job, int attempt,
                         const std::vector<std::int64_t>& numbers) override;
  void listen(std::function<void(bool cancelled)> wake) override;

  // For the store, which writes with this server's fence:
  /// The same for a job that this server has from the start, as the attempt of the record.
  records::JobRecord create_here(const records::JobRecord& record, const std::string& fingerprint);
  /// Replaces the record of a job that runs here; throws JobTaken.
  void put(const records::JobRecord& record, const std::string& bytes);
  /// Whether the job runs here; no: it has ended with this very record, whose reply was lost.
  /// Throws JobTaken if neither is so.
  bool may_end(postgres::Transaction& transaction, const records::JobRecord& record,
               const std::string& bytes) const;
  /// Ends a job that runs here, with its result in this blob (empty: none); throws JobTaken.
  void end(postgres::Transaction& transaction, const records::JobRecord& record,
           const std::string& bytes, const std::string& result, std::uint64_t result_bytes);

 private:
  /// `here`: the job is this server's at once.
  records::JobRecord insert(const records::JobRecord& record, const std::string& fingerprint,
                            const store::QueuedSize& size,
                            const std::function<void(const store::QueueTotals&)>& admit, bool here);
  std::vector<Claim> claims_of(const postgres::Result& rows);
  /// Tells the servers that there may be something to claim.
  void notify_queue();
  void notify(const char* channel);
  void enter(bool started);

  postgres::Pool& _pool;
  const std::string _name;
  std::atomic<std::int64_t> _epoch{0};
  std::mutex _beating;  ///< of the next three
  Leases _leases;
  int _beats = 0;
  bool _left = false;
  std::optional<postgres::Listener> _listener;
};

}  // namespace anticrack::group
