// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/queue.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "group/blobs.hpp"
#include "group/rows.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"

namespace anticrack::group {

namespace {

using errors::Error;
using postgres::query;
using postgres::Result;
using postgres::transact;
using postgres::Transaction;
using postgres::Value;
using records::JobRecord;
using store::EventRow;

constexpr const char* queue_channel = "anticrack_queue";
constexpr const char* cancel_channel = "anticrack_cancel";

/// By so many turns of owners a job on a mesh that is held may jump ahead.
constexpr std::int64_t slack = 20;
/// After this time the reply to a claim is lost, not late (postgres::Settings).
constexpr const char* claim_deadline = "30 s";
/// How long the events of a job are kept after its end, for watchers who come late.
constexpr const char* events_kept = "10 min";
constexpr int beats_between_cleaning = 60;
constexpr std::size_t events_a_statement = 1'000;

/// What a claim tells of the rows `taken` from the queue.
constexpr const char* select_taken =
    "SELECT j.id, j.owner, j.checksum, j.record, t.attempt, t.crashes, t.cancelled "
    "FROM taken t JOIN jobs j ON j.id = t.job ";

/// $1: epoch, $2: count, $3: meshes held, $4: slack, $5: jobs left out. Candidates are the best two
/// of each mesh that is held, moved ahead, and the best that have waited; of these the first that
/// nobody else locks, and then its mates on the mesh.
const std::string claim_statement = std::string(R"(
WITH candidates AS (
  (SELECT number, class, tag AS place FROM queue
   WHERE runner IS NULL AND queued < now() - interval '200 ms' AND job <> ALL ($5::text[])
   ORDER BY class, tag, number LIMIT 24)
  UNION ALL
  SELECT q.number, q.class, q.tag - $4::bigint FROM unnest($3::text[]) held CROSS JOIN LATERAL
    (SELECT number, class, tag FROM queue WHERE runner IS NULL AND mesh = held
       AND job <> ALL ($5::text[])
     ORDER BY class, tag, number LIMIT 2) q
), best AS MATERIALIZED (
  SELECT q.mesh, q.class, q.tag FROM candidates c JOIN queue q USING (number)
  WHERE q.runner IS NULL AND EXISTS (SELECT FROM servers WHERE epoch = $1::bigint AND NOT dead)
  ORDER BY c.class, c.place, c.number LIMIT 1 FOR UPDATE OF q SKIP LOCKED
), mates AS MATERIALIZED (
  SELECT q.number FROM best b CROSS JOIN LATERAL
    (SELECT number FROM queue WHERE runner IS NULL AND mesh = b.mesh AND class = b.class
       AND tag <= b.tag + $4::bigint AND job <> ALL ($5::text[])
     ORDER BY class, tag, number LIMIT $2::bigint FOR UPDATE SKIP LOCKED) q
), taken AS (
  UPDATE queue q SET runner = $1::bigint, attempt = attempt + 1, claimed = now()
  FROM mates m WHERE q.number = m.number
  RETURNING q.job, q.attempt, q.crashes, q.cancelled, q.tag, q.number
)
)") + select_taken + "ORDER BY t.tag, t.number";

}  // namespace

Queue::Queue(postgres::Pool& pool, std::string name) : _pool(pool), _name(std::move(name)) {
  enter(true);
}

void Queue::enter(bool started) {
  const std::int64_t before = _epoch;
  transact(_pool, [&](Transaction& transaction) {
    if (started)
      transaction.run(
          "UPDATE queue SET crashes = crashes + 1 WHERE tried && "
          "ARRAY(SELECT epoch FROM servers WHERE name = $1)",
          {_name});
    transaction.run("DELETE FROM servers WHERE name = $1 AND ($2 OR epoch = $3)",
                    {_name, started, before});
    _epoch = transaction.run("INSERT INTO servers (name) VALUES ($1) RETURNING epoch", {_name})
                 .integer(0, 0);
  });
}

void Queue::notify_queue() { notify(queue_channel); }

void Queue::notify(const char* channel) {
  try {
    query(_pool, "SELECT pg_notify($1, '')", {channel});
  } catch (const Error&) {
    // Who waits looks for himself a few times a second.
  }
}

JobRecord Queue::create(const JobRecord& record, const std::string& fingerprint,
                        const store::QueuedSize& size,
                        const std::function<void(const store::QueueTotals&)>& admit) {
  JobRecord stored = insert(record, fingerprint, size, admit, false);
  if (stored.id == record.id) notify_queue();
  return stored;
}

JobRecord Queue::create_here(const JobRecord& record, const std::string& fingerprint) {
  return insert(
      record, fingerprint, {record.spec.loads.size(), 0}, [](const auto&) {}, true);
}

JobRecord Queue::insert(const JobRecord& record, const std::string& fingerprint,
                        const store::QueuedSize& size,
                        const std::function<void(const store::QueueTotals&)>& admit, bool here) {
  const std::string bytes = store::encode(record);
  const std::string owner = to_column(record.owner), request = to_column(record.request_id),
                    mesh = to_column(record.spec.mesh);
  std::vector<std::string> uploads = store::uploads_of(record.spec);
  for (std::string& upload : uploads) upload = to_column(upload);
  const int priority = static_cast<int>(record.spec.priority);
  JobRecord stored;
  transact(_pool, [&](Transaction& transaction) {
    transaction.run("SELECT pg_advisory_xact_lock(hashtextextended($1, 0))", {owner});
    if (const auto before = same_request(transaction.run(select_request, {owner, request}),
                                         record.request_id, fingerprint)) {
      stored = store::job_of(*before);
      return;
    }
    stored = record;
    if (transaction.repeated() &&
        !transaction.run("SELECT FROM jobs WHERE id = $1", {record.id}).empty())
      return;
    hold_uploads(transaction, owner, uploads);
    const Result held = transaction.run(
        "SELECT count(*), coalesce(sum(bytes), 0)::bigint, count(*) FILTER (WHERE owner = $1), "
        "coalesce(sum(bytes) FILTER (WHERE owner = $1), 0)::bigint, "
        "coalesce(sum(cases) FILTER (WHERE mesh = $2), 0)::bigint FROM queue",
        {owner, mesh});
    admit(
        {held.count(0, 0), held.count(0, 1), held.count(0, 2), held.count(0, 3), held.count(0, 4)});
    transaction.run(
        "INSERT INTO jobs (id, owner, request, fingerprint, uploads, record, checksum) "
        "VALUES ($1, $2, $3, $4, $5, $6, $7)",
        {record.id, owner, request, fingerprint, uploads, Value::bytes(bytes),
         row_checksum(record.id, record.owner, bytes)});
    transaction.run(
        "INSERT INTO queue (job, owner, mesh, class, cases, bytes, runner, attempt, tag) "
        "SELECT $1, $2, $3, $4::smallint, $5::bigint, $6::bigint, $7::bigint, $8::integer, "
        "greatest(0, (SELECT min(tag) FROM queue WHERE runner IS NULL AND class = $4::smallint), "
        "(SELECT max(tag) + 1 FROM queue WHERE runner IS NULL AND class = $4::smallint "
        "AND owner = $2))",
        {record.id, owner, mesh, priority, size.cases, size.bytes,
         here ? std::optional(_epoch.load()) : std::nullopt, here ? record.attempt : 0});
  });
  return stored;
}

std::vector<Queue::Claim> Queue::claims_of(const Result& rows) {
  std::vector<Claim> claims;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    try {
      Claim claim{store::read_job(row_at(rows, row)), rows.integer(row, 6) != 0};
      claim.record.attempt = static_cast<int>(rows.integer(row, 4));
      claim.record.crashes = static_cast<int>(rows.integer(row, 5));
      claims.push_back(std::move(claim));
    } catch (const Error&) {  // damaged; its readers are told so
      query(_pool, "DELETE FROM queue WHERE job = $1", {rows.view(row, 0)});
    }
  }
  return claims;
}

std::vector<Queue::Claim> Queue::claim(std::size_t count, const std::vector<std::string>& held,
                                       const std::vector<std::string>& except) {
  return claims_of(query(_pool, claim_statement, {_epoch.load(), count, held, slack, except}));
}

void Queue::cancel(const std::string& job) {
  query(_pool, "UPDATE queue SET cancelled = true WHERE job = $1", {job});
  notify(cancel_channel);
}

std::optional<Queue::Claim> Queue::claim_to_cancel(const std::string& job) {
  std::vector<Claim> claims = claims_of(query(
      _pool,
      std::string(
          "WITH taken AS (UPDATE queue SET runner = $2, attempt = attempt + 1, claimed = now(), "
          "cancelled = true "
          "WHERE job = $1 AND runner IS NULL RETURNING job, attempt, crashes, cancelled) ") +
          select_taken,
      {job, _epoch.load()}));
  if (!claims.empty()) return std::move(claims.front());
  cancel(job);
  return std::nullopt;
}

Queue::News Queue::beat(const std::vector<std::string>& known) {
  const std::lock_guard lock(_beating);
  News news;
  if (_left) return news;
  news.lost = query(_pool, "UPDATE servers SET beats = beats + 1 WHERE epoch = $1 AND NOT dead",
                    {_epoch.load()})
                  .affected() == 0;
  if (news.lost) enter(false);
  const Result rows = query(_pool, "SELECT epoch, beats FROM servers WHERE NOT dead");
  const std::vector<Beat> read = rows.each([&](std::size_t row) {
    return Beat{rows.integer(row, 0), rows.integer(row, 1)};
  });
  for (const Beat& one : _leases.silent(read, std::chrono::steady_clock::now()))
    query(_pool, "UPDATE servers SET dead = true WHERE epoch = $1 AND beats = $2",
          {one.epoch, one.beats});
  std::size_t freed =
      query(_pool,
            "UPDATE queue SET runner = NULL WHERE number IN (SELECT number FROM queue q "
            "WHERE runner IS NOT NULL AND NOT EXISTS (SELECT FROM servers s "
            "WHERE s.epoch = q.runner AND NOT s.dead) FOR UPDATE SKIP LOCKED)")
          .affected();
  freed += query(_pool,
                 "UPDATE queue SET runner = NULL WHERE runner = $1 AND "
                 "claimed < now() - $3::text::interval AND NOT job = ANY ($2)",
                 {_epoch.load(), known, claim_deadline})
               .affected();
  freed += query(_pool,
                 "UPDATE portions p SET runner = NULL WHERE runner IS NOT NULL AND body IS NULL "
                 "AND NOT EXISTS (SELECT FROM servers s WHERE s.epoch = p.runner AND NOT s.dead)")
               .affected();
  if (freed > 0) notify_queue();
  news.cancelled =
      query(_pool, "SELECT job FROM queue WHERE runner = $1 AND cancelled", {_epoch.load()})
          .texts();
  if (_beats++ % beats_between_cleaning != 0) return news;
  query(_pool,
        "DELETE FROM events e WHERE written < now() - $1::text::interval AND NOT EXISTS "
        "(SELECT FROM queue q WHERE q.job = e.job)",
        {events_kept});
  // One that no job has tried any more tells nothing of crashes.
  query(_pool,
        "DELETE FROM servers WHERE dead AND NOT EXISTS (SELECT FROM queue WHERE epoch = ANY "
        "(tried))");
  return news;
}

void Queue::give_back(const std::vector<std::string>& known) {
  const Result freed =
      query(_pool, "UPDATE queue SET runner = NULL WHERE runner = $1 AND NOT job = ANY ($2)",
            {_epoch.load(), known});
  if (freed.affected() > 0) notify_queue();
}

void Queue::leave() {
  const std::lock_guard lock(_beating);
  _left = true;
  give_back({});
  query(_pool, "DELETE FROM servers WHERE epoch = $1", {_epoch.load()});
}

bool Queue::needs(const std::string& mesh) const {
  return !query(_pool, "SELECT FROM queue WHERE mesh = $1 LIMIT 1", {mesh}).empty();
}

void Queue::append(const std::vector<EventRow>& rows) {
  for (std::size_t first = 0; first < rows.size(); first += events_a_statement) {
    std::vector<std::string> jobs, bodies;
    std::vector<std::int64_t> last, attempts;
    for (const EventRow& row :
         std::span(rows).subspan(first, std::min(events_a_statement, rows.size() - first))) {
      jobs.push_back(row.job);
      bodies.push_back(row.body);
      last.push_back(static_cast<std::int64_t>(row.last));
      attempts.push_back(row.attempt);
    }
    query(_pool,
          "INSERT INTO events (job, last, body) SELECT v.job, v.last, v.body "
          "FROM unnest($2::text[], $3::bigint[], $4::bytea[], $5::bigint[]) "
          "v (job, last, body, attempt) JOIN queue q ON q.job = v.job AND q.runner = $1 "
          "AND q.attempt = v.attempt ON CONFLICT DO NOTHING",
          {_epoch.load(), jobs, last, Value::list_of_bytes(bodies), attempts});
  }
}

std::vector<EventRow> Queue::events(const std::vector<store::EventCursor>& cursors) const {
  std::vector<std::string> jobs;
  std::vector<std::int64_t> after;
  for (const store::EventCursor& cursor : cursors) {
    jobs.push_back(cursor.job);
    after.push_back(static_cast<std::int64_t>(cursor.after));
  }
  const Result rows =
      query(_pool,
            "SELECT e.job, e.last, e.body FROM unnest($1::text[], $2::bigint[]) c (job, after) "
            "CROSS JOIN LATERAL (SELECT job, last, body FROM events e WHERE e.job = c.job "
            "AND e.last > c.after ORDER BY e.last LIMIT 500) e ORDER BY e.job, e.last LIMIT 2000",
            {jobs, after});
  return rows.each([&](std::size_t row) {
    return EventRow{rows.text(row, 0), 0, rows.count(row, 1), rows.text(row, 2)};
  });
}

std::vector<std::string> Queue::ended(const std::vector<std::string>& jobs) const {
  return query(_pool,
               "SELECT id FROM unnest($1::text[]) id WHERE NOT EXISTS "
               "(SELECT FROM queue WHERE job = id)",
               {jobs})
      .texts();
}

void Queue::put(const JobRecord& record, const std::string& bytes) {
  const bool running = record.state == records::JobState::running;
  const Result done =
      query(_pool,
            "WITH mine AS (UPDATE queue SET tried = CASE WHEN $5 AND NOT tried @> ARRAY[runner] "
            "THEN tried || runner ELSE tried END WHERE job = $1 AND runner = $2 AND attempt = $3 "
            "RETURNING job) UPDATE jobs SET record = $4, checksum = $6 FROM mine WHERE jobs.id = "
            "mine.job",
            {record.id, _epoch.load(), record.attempt, Value::bytes(bytes), running,
             row_checksum(record.id, record.owner, bytes)});
  if (done.affected() == 0) throw store::JobTaken(record.id);
}

bool Queue::may_end(Transaction& transaction, const JobRecord& record,
                    const std::string& bytes) const {
  if (!transaction
           .run("SELECT FROM queue WHERE job = $1 AND runner = $2 AND attempt = $3",
                {record.id, _epoch.load(), record.attempt})
           .empty())
    return true;
  if (transaction
          .run("SELECT FROM jobs WHERE id = $1 AND ended IS NOT NULL AND record = $2",
               {record.id, Value::bytes(bytes)})
          .empty())
    throw store::JobTaken(record.id);
  return false;
}

void Queue::end(Transaction& transaction, const JobRecord& record, const std::string& bytes,
                const std::string& result, std::uint64_t result_bytes) {
  const Result ended = transaction.run(
      "WITH gone AS (DELETE FROM queue WHERE job = $1 AND runner = $2 AND attempt = $3 "
      "RETURNING job) UPDATE jobs SET record = $4, checksum = $5, ended = $6, "
      "result = nullif($7, ''), result_bytes = $8 FROM gone WHERE jobs.id = gone.job",
      {record.id, _epoch.load(), record.attempt, Value::bytes(bytes),
       row_checksum(record.id, record.owner, bytes),
       store::to_disk(record.ended.value_or(record.created)), result, result_bytes});
  if (ended.affected() == 0) throw store::JobTaken(record.id);
}

void Queue::listen(std::function<void(bool cancelled)> wake) {
  _listener.reset();
  if (!wake) return;
  _listener.emplace(_pool.settings(), std::vector<std::string>{queue_channel, cancel_channel},
                    [wake = std::move(wake)](const std::string& channel, const std::string&) {
                      wake(channel == cancel_channel);
                    });
}

}  // namespace anticrack::group
