// SPDX-License-Identifier: GPL-3.0-or-later
//
// Portions of jobs: the part of the queue by which several servers solve one.
#include "group/queue.hpp"
#include "group/rows.hpp"
#include "store/requests.hpp"

namespace anticrack::group {

using postgres::query;
using postgres::Result;
using postgres::Value;

namespace {

/// Bodies that are read at once; each has some megabytes at most.
constexpr std::size_t bodies_a_statement = 4;

/// From a job with which so many processes have died the others keep away.
constexpr int most_crashes = 2;

/// $1: epoch, $2: meshes held, $3: jobs left out, $4: most_crashes.
constexpr const char* help_statement = R"(
WITH best AS MATERIALIZED (
  SELECT number FROM queue q
  WHERE runner IS NOT NULL AND runner <> $1 AND NOT cancelled AND crashes < $4 AND job <> ALL ($3)
  AND EXISTS (SELECT FROM portions p WHERE p.job = q.job AND p.runner IS NULL)
  ORDER BY class, (SELECT count(*) FROM portions p JOIN queue o ON o.job = p.job
                   WHERE o.owner = q.owner AND p.runner <> o.runner AND p.body IS NULL),
           random() + CASE WHEN mesh = ANY ($2) THEN 0 ELSE 0.5 END LIMIT 1
), taken AS (
  UPDATE queue q SET tried = array_append(array_remove(tried, $1), $1) FROM best b
  WHERE q.number = b.number RETURNING q.job, q.attempt
)
SELECT j.id, j.owner, j.checksum, j.record, t.attempt FROM taken t JOIN jobs j ON j.id = t.job
)";

/// $1: job, $2: epoch, $3: count. What this server has already comes as well: the reply to an
/// earlier call may have been lost.
constexpr const char* take_statement = R"(
WITH wanted AS (
  SELECT FROM queue WHERE job = $1 AND NOT cancelled
), free AS MATERIALIZED (
  SELECT n FROM portions WHERE job = $1 AND runner IS NULL AND EXISTS (SELECT FROM wanted)
  ORDER BY n LIMIT $3 FOR UPDATE SKIP LOCKED
), taken AS (
  UPDATE portions p SET runner = $2 FROM free WHERE p.job = $1 AND p.n = free.n
  RETURNING p.n, p.first, p.count, p.request
)
SELECT n, first, count, request FROM portions WHERE job = $1 AND runner = $2 AND body IS NULL
AND EXISTS (SELECT FROM wanted) UNION ALL SELECT * FROM taken ORDER BY n
)";

/// $1: job, $2 to $5: number, first row, rows and request of each portion. Others are removed; of
/// growth, which has requests, only those with the same number.
constexpr const char* remove_others = R"(
DELETE FROM portions p WHERE job = $1 AND (request = '' OR n = ANY ($2)) AND NOT EXISTS (
  SELECT FROM unnest($2::bigint[], $3::bigint[], $4::bigint[], $5::bytea[])
    v (n, first, count, request)
  WHERE (v.n, v.first, v.count, v.request) = (p.n, p.first, p.count, p.request))
)";

}  // namespace

void Queue::spread(const std::string& job, int attempt,
                   const std::vector<store::Portion>& portions) {
  std::vector<std::int64_t> numbers, first, counts;
  std::vector<std::string> requests;
  for (const store::Portion& portion : portions) {
    numbers.push_back(static_cast<std::int64_t>(portion.number));
    first.push_back(static_cast<std::int64_t>(portion.first));
    counts.push_back(static_cast<std::int64_t>(portion.count));
    requests.push_back(portion.request);
  }
  const Value of_requests = Value::list_of_bytes(requests);
  transact(_pool, [&](postgres::Transaction& transaction) {
    if (transaction
            .run("SELECT FROM queue WHERE job = $1 AND runner = $2 AND attempt = $3 FOR SHARE",
                 {job, _epoch.load(), attempt})
            .empty())
      throw store::JobTaken(job);
    transaction.run(remove_others, {job, numbers, first, counts, of_requests});
    transaction.run(
        "INSERT INTO portions (job, n, first, count, request) SELECT $1, v.* FROM "
        "unnest($2::bigint[], $3::bigint[], $4::bigint[], $5::bytea[]) v ON CONFLICT DO NOTHING",
        {job, numbers, first, counts, of_requests});
  });
  notify_queue();
}

std::optional<records::JobRecord> Queue::to_help(const std::vector<std::string>& held,
                                                 const std::vector<std::string>& except) {
  const Result rows = query(_pool, help_statement, {_epoch.load(), held, except, most_crashes});
  if (rows.empty()) return std::nullopt;
  records::JobRecord record = store::read_job(row_at(rows, 0));
  record.attempt = static_cast<int>(rows.integer(0, 4));
  return record;
}

std::vector<store::Portion> Queue::take_portions(const std::string& job, std::size_t count) {
  const Result rows = query(_pool, take_statement, {job, _epoch.load(), count});
  return rows.each([&](std::size_t row) {
    return store::Portion{rows.count(row, 0), rows.count(row, 1), rows.count(row, 2),
                          rows.text(row, 3)};
  });
}

void Queue::solved(const std::string& job, const store::SolvedPortion& portion) {
  query(_pool,
        "UPDATE portions SET body = $4 WHERE job = $1 AND n = $2 AND runner = $3 AND body IS NULL",
        {job, portion.number, _epoch.load(), Value::bytes(portion.body)});
}

std::vector<store::SolvedPortion> Queue::solved_portions(
    const std::string& job, const std::vector<std::int64_t>& missing) const {
  const Result rows = query(_pool,
                            "SELECT n, body FROM portions WHERE job = $1 AND body IS NOT NULL "
                            "AND n = ANY ($2) ORDER BY n LIMIT $3",
                            {job, missing, bodies_a_statement});
  return rows.each([&](std::size_t row) {
    return store::SolvedPortion{rows.count(row, 0), rows.text(row, 1)};
  });
}

void Queue::give_back_portions(const std::string& job) {
  const Result freed = query(
      _pool, "UPDATE portions SET runner = NULL WHERE job = $1 AND runner = $2 AND body IS NULL",
      {job, _epoch.load()});
  query(_pool,
        "UPDATE queue SET tried = array_remove(tried, $2) WHERE job = $1 AND runner <> $2 "
        "AND tried @> ARRAY[$2]",
        {job, _epoch.load()});
  if (freed.affected() > 0) notify_queue();
}

void Queue::withdraw_portions(const std::string& job, int attempt,
                              const std::vector<std::int64_t>& numbers) {
  query(_pool,
        "DELETE FROM portions WHERE job = $1 AND (cardinality($4) = 0 OR n = ANY ($4)) "
        "AND EXISTS (SELECT FROM queue WHERE job = $1 AND runner = $2 AND attempt = $3)",
        {job, _epoch.load(), attempt, numbers});
}

}  // namespace anticrack::group
